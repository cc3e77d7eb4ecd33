// SPDX-License-Identifier: Apache-2.0
#include "view/explain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "base/basis.h"
#include "base/parallel.h"
#include "base/printable.h"
#include "brdf/ggx.h"
#include "brdf/merl.h"
#include "brdf/phong.h"
#include "scene/coat.h"
#include "scene/material_parameters.h"
#include "shading/anisotropic_lobe.h"
#include "shading/light.h"
#include "shading/scalar_bsdf.h"
#include "shading/share.h"

namespace nacre {
namespace {

constexpr double kDegrees = 180 / M_PI;
constexpr int kCurveSteps = 90;  // per quarter of a circle

// JSON has no infinity: values that are not finite become null.
Json NumberJson(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json TripleJson(const Vec3d& v) { return {NumberJson(v.x), NumberJson(v.y), NumberJson(v.z)}; }

double MeanOf(const Rgb& rgb) { return (rgb.x + rgb.y + rgb.z) / 3; }

double SampleOf(const Image& pixel, const std::string& name) {
  const Channel* const channel = pixel.Find(name);
  return channel != nullptr && !channel->samples.empty() ? channel->samples[0] : 0;
}

Vec3d LayerOf(const Image& pixel, const std::string& layer, const char* letters = "RGB") {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  return {SampleOf(pixel, prefix + letters[0]), SampleOf(pixel, prefix + letters[1]),
          SampleOf(pixel, prefix + letters[2])};
}

struct Point {
  Vec3d position, normal, to_view;
};

// A prepared material, and the normals at the pixel that maps may have changed.
struct ExplainedMaterial {
  ShadingMaterial prepared;
  ShadingMaterial base;             // without coats and layers
  std::vector<Vec3d> coat_normals;  // coats have normal maps of their own
  std::optional<Vec3d> unmapped;    // without normal maps, if the material or a coat has one
  std::optional<Vec3d> tangent;     // of anisotropic lobes
  std::vector<Vec3d> coat_tangents;

  StackNormals NormalsWith(const Vec3d& model) const {
    StackNormals normals(model, coat_normals);
    normals.unmapped = unmapped;
    normals.tangent = tangent;
    normals.coat_tangents = coat_tangents;
    return normals;
  }
};

// The centre of a light with an extent, for which its angles are reported; nullopt for lights all
// around.
std::optional<Vec3d> MiddleOf(const Light& light) {
  const auto middle = [](const auto& kind) -> std::optional<Vec3d> {
    if constexpr (requires { kind.center; }) return kind.center;
    if constexpr (requires { kind.mesh; }) {
      Vec3d sum(0, 0, 0);
      for (const Vec3d& corner : kind.mesh->positions) sum += corner;
      return sum / std::max(1.0, static_cast<double>(kind.mesh->positions.size()));
    }
    return {};
  };
  return std::visit(middle, light.kind);
}

// The direction from the point to a punctual light, and the unshadowed irradiance at the point.
struct Arrival {
  Vec3d to_light;
  double distance;  // infinite for directional lights
  Rgb irradiance;   // perpendicular to the light's direction
};

std::optional<Arrival> ArrivalOf(const Light& light, const Point& point) {
  if (!IsPunctual(light)) return {};
  const ShadingLight prepared = PrepareLight(light, {0, 0, 0});
  if (prepared.form == LightForm::kDirectional) {
    return Arrival{prepared.to_light, std::numeric_limits<double>::infinity(), prepared.color};
  }
  const Vec3d way = prepared.position - point.position;
  const double distance = way.length();
  if (!(distance > 0)) return {};
  const Vec3d to_light = way / distance;
  // For the usual inverse-square fall-off, PrepareLight has folded the attenuation into the colour.
  double factor = 1 / (distance * distance);
  if (prepared.form != LightForm::kInverseSquare) {
    const AttenuationTerms<double> terms{prepared.attenuation.constant, prepared.attenuation.linear,
                                         prepared.attenuation.quadratic};
    factor = AttenuationFactor(terms, distance);
  }
  if (prepared.form == LightForm::kSpot) {
    factor *= SpotFactor(prepared.cone, OneMinusCosine(-to_light, prepared.axis));
  }
  return Arrival{to_light, distance, prepared.color * factor};
}

// `frame` is that of the material's lobe.
Json TermsJson(const ShadingMaterial& material, const Basis<double>& frame, const Vec3d& to_light,
               const Vec3d& to_view) {
  const Vec3d& normal = frame.z;
  Json terms = Json::object();
  if (!((normal ^ to_light) > 0) || !((normal ^ to_view) > 0)) return terms;
  const Angles<double> a = ComputeAngles(normal, to_light, to_view);
  if (const auto* model = std::get_if<MicrofacetModel>(&material.model)) {
    const auto [distribution, visibility] = GgxTermsOf(*model, frame, to_light, to_view);
    if (model->anisotropic) {
      terms["alpha_x"] = model->anisotropic->alpha.x;
      terms["alpha_y"] = model->anisotropic->alpha.y;
    } else {
      terms["alpha"] = model->alpha;
    }
    terms["D"] = NumberJson(distribution);
    terms["G"] = NumberJson(4 * visibility * a.n_dot_l * a.n_dot_v);
    terms["V"] = NumberJson(visibility);
    terms["F"] = TripleJson(FresnelOf(*model, VDotH(a), OneMinusVDotH(a)));
  } else if (const auto* phong = std::get_if<PhongFamilyModel>(&material.model)) {
    const bool half = phong->model == PhongModel::kBlinnPhong;
    const Vec3d mirrored = normal * (2 * a.n_dot_l) - to_light;
    terms["shininess"] = phong->shininess;
    if (!half) terms["r_dot_v"] = mirrored ^ to_view;
    terms["lobe"] = NumberJson(half ? BlinnLobe(a, phong->shininess)
                                    : PhongLobe(normal, to_light, to_view, phong->shininess));
  } else if (const auto* measured = std::get_if<MeasuredModel>(&material.model)) {
    // Where in a table of MERL's form the directions lie; EPFL's has other coordinates.
    if (std::holds_alternative<MerlTable>(measured->brdf->table)) {
      const RusinkiewiczAngles at = ComputeRusinkiewicz(normal, to_light, to_view);
      terms["theta_half"] = NumberJson(at.theta_half * kDegrees);
      terms["theta_diff"] = NumberJson(at.theta_diff * kDegrees);
      terms["phi_diff"] = NumberJson(at.phi_diff * kDegrees);
    }
  }
  return terms;
}

Json LayerTermsJson(const LayerModel& layer, const LayerAngles& angles) {
  Json terms = Json::object();
  for (const auto& [name, value] : LayerTerms(layer, angles)) {
    terms[std::string(name)] = NumberJson(value);
  }
  return terms;
}

// The terms of coat k, with the angles to its normal if it has one of its own.
Json CoatTermsJson(const ShadingMaterial& material, size_t k, const StackNormals& normals,
                   const Vec3d& to_light, const Vec3d& to_view) {
  const Vec3d& n = normals.coat(k);
  Json terms = TermsJson(*material.coats[k], FrameOfCoat(material, normals, k), to_light, to_view);
  if (n == normals.model) return terms;
  const Vec3d u = to_light + to_view;
  terms["n_dot_l"] = n ^ to_light;
  terms["n_dot_v"] = n ^ to_view;
  terms["n_dot_h"] = u.length() > 0 ? (n ^ u) / u.length() : 1;
  return terms;
}

// The light that the material reflects of `irradiance` from this direction. If its model is covered
// by layers or a coat, or its lobe is mirrored at the horizon of a normal map, `json` gets, from
// bottom to top, what each of these reflects, and the factor by which it attenuates everything
// below.
Reflection ReflectedJson(const ExplainedMaterial& material, const Point& point,
                         const Vec3d& to_light, const Rgb& irradiance, Json* json) {
  const ShadingMaterial& prepared = material.prepared;
  const StackNormals normals = material.NormalsWith(point.normal);
  const Vec3d& v = point.to_view;
  const Reflection sum = Reflect(prepared, normals, to_light, v);
  const Reflection reflected = {sum.diffuse * irradiance, sum.specular * irradiance};
  const std::vector<StackLevel> levels = ReflectByLevel(prepared, normals, to_light, v);
  const bool mirrored =
      std::ranges::find(levels, kMirroredLevel, &StackLevel::name) != levels.end();
  const bool covered = !prepared.layers.empty() || !prepared.coats.empty();
  if (levels.empty() || (!covered && !mirrored)) return reflected;
  // The normals of model and coats may differ: then some of them may face the light alone.
  const auto find = [&](std::string_view name, size_t index) {
    const auto found = std::ranges::find_if(levels, [&](const StackLevel& level) {
      return level.name == name && level.index == index;
    });
    return found != levels.end() ? *found : StackLevel{name, index, {}, Rgb(1)};
  };
  const auto own_json = [&](const StackLevel& level) -> Json {
    return {{"diffuse", TripleJson(level.own.diffuse * irradiance)},
            {"specular", TripleJson(level.own.specular * irradiance)}};
  };
  (*json)["base"] = own_json(find("model", 0));
  Json covers = Json::array();
  const auto cover = [&](std::string_view name, size_t index, Json terms) {
    const StackLevel level = find(name, index);
    Json own = own_json(level);
    const bool numbered = name == "coat" && index > 0;
    own["name"] = std::string(name) + (numbered ? " " + std::to_string(index + 1) : "");
    own["below"] = TripleJson(level.below);
    own["terms"] = std::move(terms);
    covers.push_back(std::move(own));
  };
  const LayerAngles angles = LayerAnglesOf(point.normal, to_light, v);
  const bool above = angles.n_dot_l > 0 && angles.n_dot_v > 0;
  const auto cover_by_layers = [&](bool over_coats) {
    for (size_t k = 0; k < prepared.layers.size(); ++k) {
      const LayerModel& layer = prepared.layers[k];
      if (LiesOverCoats(layer) != over_coats) continue;
      cover(NameOf(layer), k, above ? LayerTermsJson(layer, angles) : Json::object());
    }
  };
  cover_by_layers(false);
  if (material.unmapped) cover(kMirroredLevel, 0, Json::object());
  for (size_t k = 0; k < prepared.coats.size(); ++k) {
    cover("coat", k, CoatTermsJson(prepared, k, normals, to_light, v));
  }
  cover_by_layers(true);
  (*json)["covers"] = std::move(covers);
  return reflected;
}

void AddAngles(const ExplainedMaterial& material, const Point& point, const Vec3d& to_light,
               Json* json) {
  const Vec3d sum = to_light + point.to_view;
  const Vec3d half = sum.length() > 0 ? sum / sum.length() : point.normal;
  (*json)["to_light"] = TripleJson(to_light);
  (*json)["n_dot_l"] = point.normal ^ to_light;
  (*json)["n_dot_v"] = point.normal ^ point.to_view;
  (*json)["n_dot_h"] = point.normal ^ half;
  (*json)["v_dot_h"] = point.to_view ^ half;
  const Basis<double> frame = FrameOfModel(material.base, material.NormalsWith(point.normal));
  (*json)["terms"] = TermsJson(material.base, frame, to_light, point.to_view);
}

Json LightJson(const Light& light, const ExplainedMaterial& material, const Point& point,
               const PixelLayers& pixel) {
  const Vec3d rendered = LayerOf(pixel.all, "light." + light.name);
  const Vec3d diffuse = LayerOf(pixel.diffuse_light, "light." + light.name);
  Json json = {{"name", Printable(light.name)},
               {"rendered", TripleJson(rendered)},
               {"rendered_diffuse", TripleJson(diffuse)},
               {"rendered_specular", TripleJson(rendered - diffuse)}};
  const std::optional<Arrival> arrival = ArrivalOf(light, point);
  if (!arrival) {
    // Its light comes from many directions, which the renderer samples.
    const std::optional<Vec3d> middle = MiddleOf(light);
    json["state"] = std::string(middle ? "area light" : "all around") + ", mean of " +
                    std::to_string(pixel.samples) + " samples";
    if (!middle) return json;
    const Vec3d way = *middle - point.position;
    const double distance = way.length();
    json["distance"] = NumberJson(distance);
    if (distance > 0) AddAngles(material, point, way / distance, &json);
    return json;
  }
  const Vec3d& l = arrival->to_light;
  AddAngles(material, point, l, &json);
  const Reflection reflected = ReflectedJson(material, point, l, arrival->irradiance, &json);
  const Rgb sum = reflected.Sum();
  const bool shows = std::max({rendered.x, rendered.y, rendered.z}) > 0;
  json["distance"] = NumberJson(arrival->distance);
  json["irradiance"] = TripleJson(arrival->irradiance);
  json["diffuse"] = TripleJson(reflected.diffuse);
  json["specular"] = TripleJson(reflected.specular);
  const bool reflects = std::max({sum.x, sum.y, sum.z}) > 0;
  json["state"] = !((point.normal ^ l) > 0) && !reflects ? "below the horizon"
                  : !shows && reflects                   ? "in shadow"
                                                         : "lit";
  return json;
}

// f n.l in the plane of normal and viewer, for light from -90 degrees (on the viewer's side) to 90.
Json LobeJson(const ExplainedMaterial& material, const Point& point) {
  const double n_dot_v = point.normal ^ point.to_view;
  Vec3d across = point.to_view - point.normal * n_dot_v;
  if (!(across.length() > 1e-9)) {
    // The viewer looks along the normal: all planes show the same.
    across = point.normal % (std::abs(point.normal.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0));
  }
  across.normalize();
  Json diffuse = Json::array(), specular = Json::array();
  for (int i = -kCurveSteps + 1; i < kCurveSteps; ++i) {
    const double angle = i / kDegrees;
    const Vec3d to_light = point.normal * std::cos(angle) - across * std::sin(angle);
    const Reflection r =
        Reflect(material.prepared, material.NormalsWith(point.normal), to_light, point.to_view);
    diffuse.push_back(NumberJson(MeanOf(r.diffuse)));
    specular.push_back(NumberJson(MeanOf(r.specular)));
  }
  return {{"first_deg", -kCurveSteps + 1},
          {"view_deg", -std::acos(std::clamp(n_dot_v, -1.0, 1.0)) * kDegrees},
          {"diffuse", std::move(diffuse)},
          {"specular", std::move(specular)}};
}

// The directional albedo over the angle from the normal: [[degrees, mean of the channels]...].
Json AlbedoCurve(const ShadingMaterial& material) {
  constexpr std::array kAngles = {0, 10, 20, 30, 40, 50, 60, 65, 70, 75, 80, 83, 86, 89};
  std::array<double, kAngles.size()> means{};
  ParallelFor(kAngles.size(), 0, [&](size_t i) {  // 30 ms each for layered materials
    means[i] = MeanOf(ReflectedShare(material, ShareOf::kFurnace, std::cos(kAngles[i] / kDegrees)));
  });
  Json curve = Json::array();
  for (size_t i = 0; i < means.size(); ++i) curve.push_back({kAngles[i], NumberJson(means[i])});
  return curve;
}

// The albedo, and for microfacet models the distribution over the angle of the half vector and the
// Fresnel term over that of v.h, in steps of a degree.
Json CurvesJson(const ShadingMaterial& material) {
  Json curves = {{"albedo", AlbedoCurve(material)}};
  const auto* const model = std::get_if<MicrofacetModel>(&material.model);
  if (model == nullptr) return curves;
  Json distribution = Json::array(), fresnel = Json::array();
  const Vec3d normal(0, 0, 1);
  for (int i = 0; i < kCurveSteps; ++i) {
    const double cosine = std::cos(i / kDegrees), sine = std::sin(i / kDegrees);
    const Vec3d half(sine, 0, cosine);  // light and viewer are both along it
    distribution.push_back(
        NumberJson(GgxDistribution(ComputeAngles(normal, half, half), model->alpha)));
    const double half_sine = std::sin(i / kDegrees / 2);
    fresnel.push_back(TripleJson(FresnelOf(*model, cosine, 2 * half_sine * half_sine)));
  }
  curves["distribution"] = std::move(distribution);
  curves["fresnel"] = std::move(fresnel);
  return curves;
}

bool IsParameterOf(const MaterialParameter& parameter, const MapTarget& target,
                   const Material& material) {
  constexpr double kOther = 0.40625;  // a value that users are unlikely to choose
  Material changed = material;
  parameter.set(changed, Rgb(kOther, kOther, kOther));
  return target.factor(changed) != target.factor(material);
}

// The material with the values of its maps at this hit. `parameters` gets name and value of the
// mapped parameters. A map is looked up by rendering the albedo of a white Lambertian that has it.
Material MaterialAtHit(const Material& material, size_t index, const PixelWith& pixel_with,
                       Json* parameters) {
  Material at_hit = material;
  const MaterialModel* const model = ModelOf(material);
  if (model == nullptr) return at_hit;
  for (const MaterialMap& map : model->maps) {
    const TextureId texture = map.get(material);
    if (!texture.valid() || map.target_count == 0) continue;
    Material white = material;
    white.model = LambertMaterial{.albedo = {1, 1, 1}, .albedo_map = texture};
    white.vertex_colors = VertexColors::kNone;
    const Rgb texel = LayerOf(pixel_with(index, white), "albedo");
    for (const MapTarget& target : TargetsOf(map)) {
      Rgb value = target.factor(at_hit);
      const double least = target.least == nullptr ? 0 : target.least(material);
      for (int c = 0; c < 3; ++c) {
        const double share = texel[target.is_color ? c : target.channel];
        value[c] = std::clamp(least + (value[c] - least) * share, 0.0, target.most);
      }
      for (const MaterialParameter& parameter : model->parameters) {
        if (!IsParameterOf(parameter, target, material)) continue;
        parameter.set(at_hit, value);
        (*parameters)[std::string(parameter.name)] =
            target.is_color ? TripleJson(value) : NumberJson(value.x);
      }
    }
    map.set(at_hit, TextureId{});
  }
  return at_hit;
}

// Prepares `at_hit`, which is MaterialAtHit of `material`. Maps of coats multiply parameters of the
// coats, which are materials of their own.
ShadingMaterial PrepareAtHit(const Material& material, const Material& at_hit, size_t index,
                             const PixelWith& pixel_with, Json* parameters) {
  ShadingMaterial prepared = PrepareMaterial(at_hit);
  const std::vector<Coat> coats = CoatsOf(material);
  for (size_t k = 0; k < coats.size(); ++k) {
    Json of_coat = Json::object();
    Coat coat = coats[k];
    coat.material = MaterialAtHit(coats[k].material, index, pixel_with, &of_coat);
    if (of_coat.empty()) continue;
    const std::string prefix = k > 0 ? "coat " + std::to_string(k + 1) + " " : "coat ";
    prepared.coats[k] = MakeShadingCoat(coat, at_hit);
    for (const auto& [name, value] : of_coat.items()) (*parameters)[prefix + name] = value;
  }
  return prepared;
}

Vec3d ToView(const Camera& camera, const Vec3d& position) {
  const Vec3d way = camera.projection == Projection::kPerspective
                        ? camera.position - position
                        : camera.position - camera.look_at;
  return way.normalized();
}

}  // namespace

Json ExplainPixel(const Scene& scene, const PixelLayers& layers, const PixelWith& pixel_with) {
  const Image& pixel = layers.all;
  Json json = {{"value", TripleJson(LayerOf(pixel, ""))}};
  const auto object = static_cast<size_t>(SampleOf(pixel, "id.object"));
  const auto number = static_cast<size_t>(SampleOf(pixel, "id.material"));
  if (object == 0 || number == 0 || number > scene.materials.size()) {
    json["background"] = true;
    return json;
  }
  Json mapped = Json::object();
  // A copy, because `pixel_with` replaces the material in the scene while it renders.
  const Material own = scene.materials[number - 1];
  const Material material = MaterialAtHit(own, number - 1, pixel_with, &mapped);
  const MaterialModel* const model = ModelOf(material);
  Point point;
  point.position = LayerOf(pixel, "P", "XYZ");
  point.normal = LayerOf(pixel, "N", "XYZ").normalized();
  point.to_view = ToView(scene.camera, point.position);
  const size_t spheres = scene.spheres.size();
  json["shape"] = object <= spheres ? "sphere " + std::to_string(object)
                                    : "mesh " + std::to_string(object - spheres);
  json["material"] = Printable(material.name);
  json["model"] = model == nullptr ? "split" : std::string(model->name);
  json["position"] = TripleJson(point.position);
  json["normal"] = TripleJson(point.normal);
  json["to_view"] = TripleJson(point.to_view);
  for (const char* const layer : {"diffuse", "specular", "ambient", "emission"}) {
    json["layers"][layer] = TripleJson(LayerOf(pixel, layer));
  }
  Json lights = Json::array();
  ExplainedMaterial explained;
  explained.prepared = PrepareAtHit(own, material, number - 1, pixel_with, &mapped);
  explained.base = explained.prepared;
  explained.base.layers.clear();
  explained.base.coats.clear();
  const bool base_mapped = own.normal_map.texture.valid() || own.bump_map.texture.valid();
  const auto normal_with = [&](const Material& other) {
    return LayerOf(pixel_with(number - 1, other), "N", "XYZ").normalized();
  };
  explained.tangent = LayerOf(pixel, "T", "XYZ").normalized();
  for (const Coat& coat : CoatsOf(own)) {
    explained.coat_tangents.push_back(
        IsAnisotropic(coat.material)
            ? LayerOf(pixel_with(number - 1, coat.material), "T", "XYZ").normalized()
            : Vec3d(0));
  }
  bool any_mapped = base_mapped;
  for (const Coat& coat : CoatsOf(own)) {
    const bool mapped = coat.material.normal_map.texture.valid();
    any_mapped = any_mapped || mapped;
    explained.coat_normals.push_back(base_mapped || mapped ? normal_with(coat.material)
                                                           : point.normal);
  }
  if (any_mapped) {
    Material unmapped = own;
    unmapped.normal_map = {};
    unmapped.bump_map = {};
    explained.unmapped = normal_with(unmapped);
  }
  for (const Light& light : scene.lights) {
    if (std::holds_alternative<AmbientLight>(light.kind)) continue;
    lights.push_back(LightJson(light, explained, point, layers));
  }
  json["mapped"] = std::move(mapped);
  json["lights"] = std::move(lights);
  json["lobe"] = LobeJson(explained, point);
  json["curves"] = CurvesJson(explained.prepared);
  return json;
}

}  // namespace nacre
