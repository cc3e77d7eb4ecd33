// SPDX-License-Identifier: Apache-2.0
// tests/api/user_brdf_test.cc: reflection models of the caller's own: nacre's models, passed back
// as functions, beside these models themselves.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "catch.h"
#include "nacre.h"

namespace {

using nacre::Parameters;

// A model's own BRDF as functions, with its sampler if `sampled`.
nacre::UserBrdf AsFunctions(const nacre::Brdf& brdf, bool sampled) {
  nacre::UserBrdf user;
  user.evaluate = [=](const nacre::Directions& d, const std::array<double*, 3>& rgb) {
    const nacre::ExactReflections found = brdf.Evaluate(d);
    for (size_t i = 0; i < d.count; ++i) {
      const double n_dot_l = d.normal[0][i] * d.to_light[0][i] + d.normal[1][i] * d.to_light[1][i] +
                             d.normal[2][i] * d.to_light[2][i];
      for (size_t c = 0; c < 3; ++c) {
        rgb[c][i] = (found.diffuse[c][i] + found.specular[c][i]) / n_dot_l;
      }
    }
  };
  if (!sampled) return user;
  user.sample = [=](const nacre::Directions& d, const double* u, const double* v,
                    const std::array<double*, 3>& to_light) {
    const auto found = brdf.Sample(d, u, v);
    for (size_t c = 0; c < 3; ++c) std::copy(found[c].begin(), found[c].end(), to_light[c]);
  };
  user.pdf = [=](const nacre::Directions& d, double* pdf) {
    const std::vector<double> found = brdf.Pdf(d);
    std::copy(found.begin(), found.end(), pdf);
  };
  return user;
}

// Two spheres, one of which shades the other.
nacre::Scene Spheres(const Parameters& light) {
  nacre::Scene scene;
  scene.SetCamera({{"position", {0, 1, 6}}, {"fov_y_deg", 35}});
  scene.AddLight("light", light);
  scene.AddSphere({-0.6, 0, 0}, 1, "ball");
  scene.AddSphere({1.2, 0.6, 0.8}, 0.5, "ball");
  return scene;
}

nacre::RenderSettings Small(int samples) {
  return {.width = 48, .height = 36, .samples = samples, .threads = 2};
}

double Mean(const nacre::Image& image) {
  double sum = 0;
  for (const float value : image.Find("G")->samples) sum += value;
  return sum / static_cast<double>(image.Find("G")->samples.size());
}

// The largest difference, relative to the mean.
double Difference(const nacre::Image& a, const nacre::Image& b) {
  return nacre::Compare(a, b, {.layers = {""}}).layers[0].max_abs / Mean(b);
}

const Parameters kPoint = {{"type", "point"}, {"position", {4, 4, 5}}, {"intensity", 80}};
const Parameters kSun = {
    {"type", "directional"}, {"direction_of_travel", {-1, -1, -1}}, {"irradiance", 3}};
const Parameters kDisk = {{"type", "disk"},
                          {"center", {3, 3, 3}},
                          {"facing", {-1, -1, -1}},
                          {"radius", 1},
                          {"radiance", 10}};
const Parameters kSky = {
    {"type", "environment"},
    {"gradient", Parameters{{"zenith", 2}, {"horizon", {1, 1, 1}}, {"ground", 0.1}}}};

TEST_CASE("a user's model is rendered as nacre's, which it repeats") {
  // Burley's diffuse term has no closed form and no lobe: both are sampled in the same directions.
  const Parameters burley = {{"model", "burley"}, {"albedo", {0.8, 0.5, 0.2}}, {"roughness", 0.7}};
  const nacre::Brdf brdf("burley", {burley[1], burley[2]});
  for (const Parameters& light : {kPoint, kSun, kDisk, kSky}) {
    INFO(light[0].value.json());
    nacre::Scene scene = Spheres(light);
    scene.AddMaterial("ball", burley);
    const nacre::Image expected = nacre::Render(scene, Small(4));
    REQUIRE(Mean(expected) > 0.01);
    scene.AddMaterial("ball", AsFunctions(brdf, false));
    // Floats of kernels beside doubles: both are within some 1e-6 of the term.
    CHECK(Difference(nacre::Render(scene, Small(4)), expected) < 2e-5);
  }
}

TEST_CASE("highlights of a user's model are as exact as nacre's") {
  const Parameters metal = {{"model", "metallic_roughness"}, {"metallic", 1}, {"roughness", 0.05}};
  const nacre::Brdf brdf("metallic_roughness", {metal[1], metal[2]});
  for (const Parameters& light : {kPoint, kSun}) {
    nacre::Scene scene = Spheres(light);
    scene.AddMaterial("ball", metal);
    const nacre::Image expected = nacre::Render(scene, Small(4));
    scene.AddMaterial("ball", AsFunctions(brdf, false));
    const nacre::Image got = nacre::Render(scene, Small(4));
    const nacre::LayerMetrics found = nacre::Compare(got, expected, {.layers = {""}}).layers[0];
    CHECK(found.max_rel < 1e-4);  // tests/shading/highlight_test.cc's bound of the kernels
  }
}

TEST_CASE("with or without a sampler, a user's model converges to the same picture") {
  const nacre::Brdf brdf("conductor", {{"preset", "gold"}, {"roughness", 0.4}});
  for (const Parameters& light : {kDisk, kSky}) {
    INFO(light[0].value.json());
    nacre::Scene scene = Spheres(light);
    scene.AddMaterial("ball", {{"model", "conductor"}, {"preset", "gold"}, {"roughness", 0.4}});
    const nacre::Image expected = nacre::Render(scene, Small(64));
    for (const bool sampled : {false, true}) {
      scene.AddMaterial("ball", AsFunctions(brdf, sampled));
      const nacre::Image got = nacre::Render(scene, Small(64));
      // The mean of a hundred thousand samples, whose standard deviation is about their mean.
      CHECK(std::abs(Mean(got) / Mean(expected) - 1) < 0.01);
      // With the model's own sampler all directions are the same. Without it there is noise, some
      // .19 of the mean under the disk.
      const double rmse = nacre::Compare(got, expected, {.layers = {""}}).layers[0].rmse;
      CHECK(rmse < (sampled ? 1e-4 : 0.25) * Mean(expected));
    }
  }
}

TEST_CASE("layers lie over a user's model") {
  const Parameters base = {{"base_color", {0.6, 0.3, 0.1}}, {"roughness", 0.5}};
  const Parameters layers = {
      {"coat", 1}, {"coat_roughness", 0.2}, {"sheen_color", 0.5}, {"sheen_roughness", 0.4}};
  Parameters whole = {{"model", "metallic_roughness"}};
  whole.insert(whole.end(), base.begin(), base.end());
  whole.insert(whole.end(), layers.begin(), layers.end());
  nacre::Scene scene = Spheres(kPoint);
  scene.AddMaterial("ball", whole);
  const nacre::Image expected = nacre::Render(scene, Small(4));
  scene.AddMaterial("ball", AsFunctions(nacre::Brdf("metallic_roughness", base), false), whole);
  CHECK(Difference(nacre::Render(scene, Small(4)), expected) < 2e-5);
}

TEST_CASE("threads and layers change no bit of a user's model, and sessions keep it") {
  const nacre::Brdf brdf("oren_nayar", {{"albedo", 0.8}});
  nacre::Scene scene = Spheres(kSky);
  scene.AddMaterial("ball", AsFunctions(brdf, false), {{"albedo", 0.25}});
  scene.AddLight("key", kPoint);
  const nacre::Image expected = nacre::Render(scene, Small(2));
  nacre::RenderSettings settings = Small(2);
  settings.threads = 1;
  settings.layers = {"all"};
  const nacre::Image all = nacre::Render(scene, settings);
  CHECK(all.Find("G")->samples == expected.Find("G")->samples);
  CHECK(*std::max_element(all.Find("albedo.G")->samples.begin(),
                          all.Find("albedo.G")->samples.end()) == 0.25f);
  nacre::Session session(scene);
  CHECK(session.Render(Small(2)).Find("G")->samples == expected.Find("G")->samples);
  session.Set("/materials/ball/emission", 1);
  CHECK(Mean(session.Render(Small(2))) > Mean(expected) + 0.1);
  session.Set("/materials/ball/emission", 0);
  CHECK(session.Render(Small(2)).Find("G")->samples == expected.Find("G")->samples);
  // A material of the same name takes its place.
  const Parameters black = {{"model", "lambert"}, {"albedo", 0}};
  scene.AddMaterial("ball", black);
  nacre::Scene other = Spheres(kSky);
  other.AddMaterial("ball", black);
  other.AddLight("key", kPoint);
  CHECK(nacre::Render(scene, Small(2)).Find("G")->samples ==
        nacre::Render(other, Small(2)).Find("G")->samples);
}

TEST_CASE("a user's model works under --max-error") {
  nacre::Scene scene = Spheres(kPoint);
  scene.AddMaterial("ball", {{"model", "burley"}});
  nacre::RenderSettings settings = Small(0);
  settings.max_error = 0.01;
  const nacre::Image expected = nacre::Render(scene, settings);
  scene.AddMaterial("ball", AsFunctions(nacre::Brdf("burley"), false));
  CHECK(std::abs(Mean(nacre::Render(scene, settings)) / Mean(expected) - 1) < 0.01);
}

// The share of values that are within `max_error` of the truth, as --max-error counts.
double ShareWithin(const nacre::Image& image, const nacre::Image& truth, double max_error) {
  const std::vector<float>& got = image.Find("G")->samples;
  const std::vector<float>& wanted = truth.Find("G")->samples;
  size_t within = 0;
  for (size_t i = 0; i < got.size(); ++i) {
    const double bound = max_error * std::max(std::abs(double{wanted[i]}), 0.05);
    within += std::abs(double{got[i]} - wanted[i]) <= bound ? 1 : 0;
  }
  return static_cast<double>(within) / static_cast<double>(got.size());
}

TEST_CASE("rings that a user's model draws between pixel centres are found by --max-error") {
  nacre::UserBrdf rings;
  rings.evaluate = [](const nacre::Directions& d, const std::array<double*, 3>& rgb) {
    for (size_t i = 0; i < d.count; ++i) {
      double n_dot_l = 0;
      for (size_t c = 0; c < 3; ++c) n_dot_l += d.normal[c][i] * d.to_light[c][i];
      const double turn = 8 * n_dot_l - std::round(8 * n_dot_l);
      for (size_t c = 0; c < 3; ++c) rgb[c][i] = std::abs(turn) < 0.02 ? 2.1 : 0.1;
    }
  };
  nacre::Scene scene;
  scene.SetCamera({{"position", {0, 0, 6}}, {"fov_y_deg", 30}});
  scene.AddLight("light", kSun);
  scene.AddMaterial("ball", rings);
  scene.AddSphere({0, 0, 0}, 1, "ball");
  const nacre::Image truth = nacre::Render(scene, Small(1024));
  nacre::RenderSettings settings = Small(0);
  settings.max_error = 0.1;
  const nacre::Image got = nacre::Render(scene, settings);
  CHECK(ShareWithin(got, truth, 0.1) >= 0.95);
  // Those of pixels whose centres see none would be .1 to .2 of the light.
  CHECK(std::abs(Mean(got) / Mean(truth) - 1) < 0.02);
}

TEST_CASE("how narrow the lobe of a user's model is, is measured for --max-error") {
  // Highlights smaller than pixels, which are looked for by the width of the lobe.
  const Parameters metal = {{"model", "metallic_roughness"}, {"metallic", 1}, {"roughness", 0.15}};
  nacre::Scene scene;
  scene.SetCamera({{"position", {0, 0, 40}}, {"fov_y_deg", 8}});
  scene.AddLight("light", kSun);
  for (int i = 0; i < 16; ++i) scene.AddSphere({i % 4 * 1.3 - 2, i / 4 * 1.3 - 2, 0}, 0.6, "ball");
  nacre::RenderSettings settings = Small(0);
  settings.width = settings.height = 20;
  settings.max_error = 0.05;
  nacre::RenderStats of_model, of_functions;
  scene.AddMaterial("ball", metal);
  const nacre::Image expected = nacre::Render(scene, settings, &of_model);
  const nacre::Brdf brdf("metallic_roughness", {metal[1], metal[2]});
  scene.AddMaterial("ball", AsFunctions(brdf, false));
  const nacre::Image got = nacre::Render(scene, settings, &of_functions);
  const double ratio =
      static_cast<double>(of_functions.camera_rays) / static_cast<double>(of_model.camera_rays);
  INFO(ratio);
  CHECK(std::abs(ratio - 1) < 0.05);
  CHECK(Difference(got, expected) < 0.02);
}

TEST_CASE("functions are asked for what is above the surface alone") {
  std::atomic<bool> right = true;
  std::atomic<size_t> most = 0;
  nacre::UserBrdf brdf;
  brdf.evaluate = [&](const nacre::Directions& d, const std::array<double*, 3>& rgb) {
    most = std::max(most.load(), d.count);
    for (size_t i = 0; i < d.count; ++i) {
      for (const auto* direction : {&d.to_view, &d.to_light}) {
        double cosine = 0, squared = 0;
        for (size_t c = 0; c < 3; ++c) {
          cosine += d.normal[c][i] * (*direction)[c][i];
          squared += (*direction)[c][i] * (*direction)[c][i];
        }
        // Directions that renders choose are unit in float.
        if (!(cosine > 0) || std::abs(squared - 1) > 16 * 0x1p-24) right = false;
      }
      for (size_t c = 0; c < 3; ++c) rgb[c][i] = 0.1;
    }
  };
  for (const Parameters& light : {kPoint, kSun, kDisk, kSky}) {
    nacre::Scene scene = Spheres(light);
    // At its outline interpolated normals lean away from the viewer.
    scene.AddShape({{"type", "icosphere"},
                    {"center", {-0.6, 0, 2}},
                    {"radius", 0.8},
                    {"subdivisions", 1},
                    {"material", "ball"}});
    scene.AddMaterial("ball", brdf);
    nacre::Render(scene, Small(4));
  }
  CHECK(right);
  CHECK(most > 100);
}

TEST_CASE("what a user's function does wrong is told, and names the sample") {
  nacre::Scene scene = Spheres(kPoint);
  const auto message = [&](const nacre::UserBrdf& brdf) -> std::string {
    try {
      scene.AddMaterial("ball", brdf);
      nacre::Render(scene, Small(1));
    } catch (const nacre::Error& error) {
      return error.what();
    }
    return "no error";
  };
  nacre::UserBrdf brdf;
  CHECK(message(brdf).find("has no `evaluate`") != std::string::npos);
  brdf.evaluate = [](const nacre::Directions& d, const std::array<double*, 3>& rgb) {
    for (size_t c = 0; c < 3; ++c) std::fill_n(rgb[c], d.count, std::nan(""));
  };
  const std::string text = message(brdf);
  INFO(text);
  CHECK(text.find("material \"ball\": its function returned nan for sample 0 of") !=
        std::string::npos);
  CHECK(text.find("to_light (") != std::string::npos);
  brdf.sample = [](const nacre::Directions&, const double*, const double*,
                   const std::array<double*, 3>&) {};
  CHECK(message(brdf).find("only one of `sample` and `pdf`") != std::string::npos);
  nacre::UserBrdf thrower;
  thrower.evaluate = [](const nacre::Directions&, const std::array<double*, 3>&) {
    throw std::runtime_error("mine");
  };
  scene.AddMaterial("ball", thrower);
  CHECK_THROWS_WITH(nacre::Render(scene, Small(1)), "mine");
}

}  // namespace
