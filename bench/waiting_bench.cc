// SPDX-License-Identifier: Apache-2.0
// bench/waiting_bench.cc: what bench/waiting.py cannot do from outside: sessions of the library,
// and bare libraries that do the same work. Prints JSON.
//
//   session SCENE WIDTHxHEIGHT SAMPLES COUNT POINTER VALUE...
//       sets the values one after the other, COUNT times, and renders after each: seconds from Set
//       to the picture, and those of the render part alone
//   cancel SCENE COUNT
//       cancels a session's first render COUNT times, each a hundredth of a second later than the
//       one before: seconds from Cancel to the render's end
//   embree TRIANGLES COUNT   builds a bare Embree tree of a square of triangles
//   rays SPHERES COUNT       incoherent rays, one thread: nearest sphere, and whether one is in the
//                            way; nanoseconds a ray, and Embree's for its own spheres in float
//   packets TARGET COUNT     such rays in packets and one by one, on a SIMD target, by the number
//   of
//                            spheres and triangles: the table that src/embree/box_trees.cc is from
//   clouds TARGET SPHERES SAMPLES COUNT
//       a frame of a cloud of spheres by tiles and by a tree on a SIMD target, by how many of them
//       a ray passes on average: the table that src/render/camera_cost.cc is from
//   spng FILE COUNT          decodes a PNG file by libspng alone
//   jpeg IN OUT              writes a picture as JPEG
//   brdf PAIRS COUNT         evaluates a model at pairs of directions, by the float kernels
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <spng.h>

#include "base/float_mode.h"
#include "base/seconds_since.h"
#include "base/target.h"
#include "embree_tree.h"
#include "hit/batch.h"
#define NACRE_OWN_SOURCE  // the renderer's own types are here as well
#include "nacre.h"
#include "render/camera.h"
#include "render/camera_cost.h"
#include "render/render.h"
#include "scene/scene.h"
#include "visibility/intersector.h"

namespace {

namespace api = nacre::v0;
using Clock = std::chrono::steady_clock;

void PrintList(const char* name, const std::vector<double>& values, const char* end) {
  std::printf("\"%s\": [", name);
  for (size_t i = 0; i < values.size(); ++i) std::printf("%s%.9g", i == 0 ? "" : ", ", values[i]);
  std::printf("]%s", end);
}

std::vector<double> Time(int count, const std::function<void()>& work) {
  std::vector<double> seconds;
  for (int i = 0; i < count; ++i) {
    const auto start = Clock::now();
    work();
    seconds.push_back(nacre::SecondsSince(start));
  }
  return seconds;
}

void PrintSeconds(const std::vector<double>& seconds) {
  std::printf("{");
  PrintList("seconds", seconds, "}\n");
}

// ---- Sessions -----------------------------------------------------------------------------------

void RunSession(char** arguments, int count) {
  api::RenderSettings settings;
  if (std::sscanf(arguments[1], "%dx%d", &settings.width, &settings.height) != 2) {
    throw std::invalid_argument("the size is not WIDTHxHEIGHT");
  }
  settings.samples = std::atoi(arguments[2]);
  const int repetitions = std::atoi(arguments[3]);
  const std::string pointer = arguments[4];
  std::vector<api::Value> values;
  for (int i = 5; i < count; ++i) values.push_back(api::Value::Json(arguments[i]));
  if (values.empty()) throw std::invalid_argument("a value is missing");
  const auto start = Clock::now();
  api::Session session(api::Scene::FromFile(arguments[0]));
  session.Render(settings);
  const double first = nacre::SecondsSince(start);
  std::vector<double> whole, render;
  for (int i = 0; i < repetitions; ++i) {
    api::RenderStats stats;
    const auto begin = Clock::now();
    session.Set(pointer, values[static_cast<size_t>(i) % values.size()]);
    session.Render(settings, &stats);
    whole.push_back(nacre::SecondsSince(begin));
    render.push_back(stats.render_seconds);
  }
  std::printf("{\"first\": %.9g, ", first);
  PrintList("seconds", whole, ", ");
  PrintList("render", render, "}\n");
}

void CancelRenders(const char* scene, int count) {
  api::Session session(api::Scene::FromFile(scene));
  std::vector<double> seconds;
  for (int i = 0; i < count; ++i) {
    Clock::time_point asked;
    std::thread other([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(10 * (i + 1)));
      asked = Clock::now();
      session.Cancel();
    });
    bool cancelled = false;
    try {
      session.Render();
    } catch (const api::Cancelled&) {
      cancelled = true;
    }
    const Clock::time_point ended = Clock::now();
    other.join();
    if (!cancelled) break;  // the render was faster
    seconds.push_back(std::chrono::duration<double>(ended - asked).count());
  }
  PrintSeconds(seconds);
}

// ---- Embree -------------------------------------------------------------------------------------

void BuildTriangles(int triangles, int count) {
  const auto side = static_cast<unsigned>(std::lround(std::sqrt(triangles / 2.0)));
  const nacre::DevicePointer device = nacre::MakeDevice();
  // The buffers are given to Embree with the tree, as whoever reads a file has to.
  PrintSeconds(Time(count, [&] {
    RTCGeometry mesh = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* position = static_cast<float*>(
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), size_t{side + 1} * (side + 1)));
    for (unsigned y = 0; y <= side; ++y) {
      for (unsigned x = 0; x <= side; ++x) {
        *position++ = static_cast<float>(x);
        *position++ = static_cast<float>((x * 7 + y * 13) % 5) * 0.1f;
        *position++ = static_cast<float>(y);
      }
    }
    auto* index = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(unsigned), size_t{2} * side * side));
    for (unsigned y = 0; y < side; ++y) {
      for (unsigned x = 0; x < side; ++x) {
        const unsigned a = y * (side + 1) + x, b = a + side + 1;
        for (const unsigned corner : {a, b, a + 1, a + 1, b, b + 1}) *index++ = corner;
      }
    }
    nacre::BuildTree(mesh, device.get());
  }));
}

#if RTC_VERSION_MAJOR == 3
void IntersectOne(RTCScene tree, RTCRayHit* ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(tree, &context, ray);
}
void OccludedOne(RTCScene tree, RTCRay* ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(tree, &context, ray);
}
#else
void IntersectOne(RTCScene tree, RTCRayHit* ray) { rtcIntersect1(tree, ray, nullptr); }
void OccludedOne(RTCScene tree, RTCRay* ray) { rtcOccluded1(tree, ray, nullptr); }
#endif

// ---- Incoherent rays ----------------------------------------------------------------------------

constexpr size_t kRays = 64 * nacre::kBatchCapacity;

// Spheres all over a cube; a line through it meets about one of them, however many there are.
nacre::Scene MakeSpheres(int count, std::minstd_rand* random) {
  std::uniform_real_distribution<double> coordinate(-1, 1);
  nacre::Scene scene;
  scene.materials.emplace_back();
  const double radius = std::sqrt(2.0 / (M_PI * count));
  for (int i = 0; i < count; ++i) {
    nacre::Sphere sphere;
    sphere.center = {coordinate(*random), coordinate(*random), coordinate(*random)};
    sphere.radius = radius;
    sphere.material = {0};
    scene.spheres.push_back(sphere);
  }
  return scene;
}

struct Rays {
  std::vector<nacre::Vec3d> origins, directions;
};

// So many in a row start at one point, as light from all around a place in a picture does.
Rays MakeRays(size_t together, std::minstd_rand* random) {
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::normal_distribution<double> normal;
  Rays rays;
  for (size_t i = 0; i < kRays; ++i) {
    if (i % together == 0) {
      rays.origins.emplace_back(coordinate(*random), coordinate(*random), coordinate(*random));
    } else {
      rays.origins.push_back(rays.origins.back());
    }
    rays.directions.emplace_back(normal(*random), normal(*random), normal(*random));
  }
  return rays;
}

// Nanoseconds a ray: of trace(), which traces all of them.
std::vector<double> TimeRays(int count, const std::function<void()>& trace) {
  trace();
  std::vector<double> times = Time(count, trace);
  for (double& time : times) time *= 1e9 / static_cast<double>(kRays);
  return times;
}

struct Batches {
  std::vector<nacre::RayBatch> rays;
  std::vector<nacre::ShadowRayBatch> shadows;
};

Batches MakeBatches(const Rays& rays) {
  Batches made{std::vector<nacre::RayBatch>(kRays / nacre::kBatchCapacity),
               std::vector<nacre::ShadowRayBatch>(kRays / nacre::kBatchCapacity)};
  for (size_t i = 0; i < kRays; ++i) {
    const size_t batch = i / nacre::kBatchCapacity, place = i % nacre::kBatchCapacity;
    nacre::RayBatch& to = made.rays[batch];
    nacre::ShadowRayBatch& shadow = made.shadows[batch];
    to.count = shadow.count = place + 1;
    nacre::SetVector(rays.origins[i], place, &to.origin);
    nacre::SetVector(rays.directions[i], place, &to.direction);
    nacre::SetVector(rays.origins[i], place, &shadow.origin);
    nacre::SetVector(rays.directions[i], place, &shadow.direction);
    shadow.t_max[place] = INFINITY;
    shadow.primitive[place] = nacre::kNoPrimitive;
    shadow.own_after[place] = nacre::kLeavesToEitherSide;
    shadow.camera_extent = 2;
  }
  return made;
}

// A triangle in the place of each sphere.
nacre::Scene AsTriangles(const nacre::Scene& spheres, std::minstd_rand* random) {
  std::normal_distribution<double> normal;
  nacre::Scene scene;
  scene.materials.emplace_back();
  nacre::Mesh& mesh = scene.meshes.emplace_back();
  mesh.material = {0};
  for (const nacre::Sphere& sphere : spheres.spheres) {
    for (int corner = 0; corner < 3; ++corner) {
      const nacre::Vec3d away(normal(*random), normal(*random), normal(*random));
      mesh.triangles.push_back(static_cast<uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(sphere.center + away.normalized() * sphere.radius);
    }
  }
  return scene;
}

// Nanoseconds a ray, in packets and one by one in turn, as medians: of nearest hits and of whether
// anything is in the way.
void CompareWithPackets(const char* what, const nacre::Scene& scene, size_t size, int count,
                        Batches* batches) {
  std::array<std::vector<double>, 4> times;
  std::array<std::unique_ptr<nacre::Intersector>, 2> trees;
  for (size_t i = 0; i < 2; ++i) {
    nacre::IntersectorSettings settings;
    settings.one_by_one = i == 1;
    trees[i] = std::make_unique<nacre::Intersector>(scene, nacre::Vec3d(0, 0, 0), settings);
  }
  nacre::ClosestHits hits;
  for (int turn = 0; turn <= count; ++turn) {
    for (size_t i = 0; i < 4; ++i) {
      const auto start = Clock::now();
      const nacre::Intersector& tree = *trees[i % 2];
      if (i < 2) {
        for (const nacre::RayBatch& batch : batches->rays) tree.Closest(batch, &hits);
      } else {
        for (nacre::ShadowRayBatch& batch : batches->shadows) tree.Occluded(&batch);
      }
      if (turn > 0) times[i].push_back(1e9 * nacre::SecondsSince(start) / kRays);
    }
  }
  std::array<double, 4> medians{};
  for (size_t i = 0; i < 4; ++i) {
    auto middle = times[i].begin() + static_cast<ptrdiff_t>(times[i].size() / 2);
    std::nth_element(times[i].begin(), middle, times[i].end());
    medians[i] = *middle;
  }
  std::printf("%-7s %-26s %8zu %9.0f %9.0f %6.2f %9.0f %9.0f %6.2f\n",
              nacre::TargetName(nacre::ActiveTarget()).c_str(), what, size, medians[0], medians[1],
              medians[1] / medians[0], medians[2], medians[3], medians[3] / medians[2]);
  std::fflush(stdout);
}

void ComparePackets(int count) {
  const nacre::FlushDenormals flush;
  std::minstd_rand random(1);
  std::array<Batches, 2> batches = {MakeBatches(MakeRays(1, &random)),
                                    MakeBatches(MakeRays(64, &random))};
  std::printf(
      "target  shapes                        many  closest:    alone  ratio occluded:   alone  "
      "ratio\n");
  for (int size = 16; size <= 1 << 16; size *= 2) {
    const nacre::Scene spheres = MakeSpheres(size, &random);
    const nacre::Scene triangles = AsTriangles(spheres, &random);
    const auto many = static_cast<size_t>(size);
    CompareWithPackets("spheres", spheres, many, count, &batches[0]);
    CompareWithPackets("triangles", triangles, many, count, &batches[0]);
    CompareWithPackets("spheres, from one point", spheres, many, count, &batches[1]);
    CompareWithPackets("triangles, from one point", triangles, many, count, &batches[1]);
  }
}

void TraceRays(int spheres, int count) {
  const nacre::FlushDenormals flush;
  std::minstd_rand random(1);
  const nacre::Scene scene = MakeSpheres(spheres, &random);
  const Rays rays = MakeRays(1, &random);

  const nacre::Intersector intersector(scene, {0, 0, 0}, {});
  auto [batches, shadows] = MakeBatches(rays);
  nacre::ClosestHits hits;
  size_t found = 0, dark = 0;
  const std::vector<double> closest = TimeRays(count, [&] {
    found = 0;
    for (const nacre::RayBatch& batch : batches) {
      intersector.Closest(batch, &hits);
      for (size_t i = 0; i < batch.count; ++i) found += hits.primitive[i] != nacre::kNoPrimitive;
    }
  });
  const std::vector<double> occluded = TimeRays(count, [&] {
    dark = 0;
    for (nacre::ShadowRayBatch& batch : shadows) {
      intersector.Occluded(&batch);
      for (size_t i = 0; i < batch.count; ++i) dark += batch.occluded[i];
    }
  });

  const nacre::DevicePointer device = nacre::MakeDevice();
  RTCGeometry points = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
  auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(points, RTC_BUFFER_TYPE_VERTEX, 0,
                                                             RTC_FORMAT_FLOAT4, 4 * sizeof(float),
                                                             scene.spheres.size()));
  for (const nacre::Sphere& sphere : scene.spheres) {
    for (const double value : {sphere.center.x, sphere.center.y, sphere.center.z, sphere.radius}) {
      *vertex++ = static_cast<float>(value);
    }
  }
  const nacre::ScenePointer tree = nacre::BuildTree(points, device.get());
  const auto make_ray = [&](size_t i) {
    RTCRayHit ray = {};
    ray.ray.org_x = static_cast<float>(rays.origins[i].x);
    ray.ray.org_y = static_cast<float>(rays.origins[i].y);
    ray.ray.org_z = static_cast<float>(rays.origins[i].z);
    ray.ray.dir_x = static_cast<float>(rays.directions[i].x);
    ray.ray.dir_y = static_cast<float>(rays.directions[i].y);
    ray.ray.dir_z = static_cast<float>(rays.directions[i].z);
    ray.ray.tfar = INFINITY;
    ray.ray.mask = 0xffffffffu;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return ray;
  };
  std::vector<RTCRayHit> made(kRays);
  for (size_t i = 0; i < kRays; ++i) made[i] = make_ray(i);
  size_t embree_found = 0, embree_dark = 0;
  const std::vector<double> intersect1 = TimeRays(count, [&] {
    embree_found = 0;
    for (RTCRayHit ray : made) {
      IntersectOne(tree.get(), &ray);
      embree_found += ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
  });
  const std::vector<double> occluded1 = TimeRays(count, [&] {
    embree_dark = 0;
    for (const RTCRayHit& one : made) {
      RTCRay ray = one.ray;
      OccludedOne(tree.get(), &ray);
      embree_dark += ray.tfar < 0;
    }
  });
  std::printf("{\"hits\": [%zu, %zu, %zu, %zu], ", found, dark, embree_found, embree_dark);
  PrintList("closest_ns", closest, ", ");
  PrintList("occluded_ns", occluded, ", ");
  PrintList("embree_intersect1_ns", intersect1, ", ");
  PrintList("embree_occluded1_ns", occluded1, "}\n");
}

// ---- Clouds -------------------------------------------------------------------------------------

double MedianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Spheres all over a cube that fills the picture: a ray passes `depth` of them on average.
nacre::Scene MakeCloud(int count, double depth, int samples) {
  std::minstd_rand random(1);
  nacre::Scene scene = MakeSpheres(count, &random);
  for (nacre::Sphere& sphere : scene.spheres) sphere.radius *= std::sqrt(2 * depth);
  scene.camera.position = {0, 0, 8};
  scene.camera.look_at = {0, 0, 0};
  scene.camera.fov_y_deg = 12;
  scene.image.width = 1280;
  scene.image.height = 720;
  scene.image.spp = samples;
  return scene;
}

// On one thread, in turn, in milliseconds: the plan of a new view (bins, or nothing new), and what
// camera rays take in a frame; once, the tree. Then what TreeSaves says of it all.
void CompareClouds(int spheres, int samples, int count) {
  std::printf(
      " spheres   depth  tiles: view   rays  tree: built  view   rays  saves, says the model   "
      "cells, camera rays\n");
  for (const double depth : {0.1, 1.0, 4.0, 16.0, 64.0, 256.0}) {
    const nacre::Scene scene = MakeCloud(spheres, depth, samples);
    std::array<std::vector<double>, 2> view, rays;
    std::array<nacre::PreparedScene, 2> prepared;
    double built = 0;
    for (int turn = 0; turn <= count; ++turn) {
      for (size_t i = 0; i < 2; ++i) {
        nacre::RenderSettings settings;
        settings.threads = 1;
        settings.time_stages = true;
        settings.intersector =
            i == 0 ? nacre::IntersectorChoice::kTiles : nacre::IntersectorChoice::kEmbree;
        prepared[i].versions.Change(nacre::ScenePart::kCamera);
        nacre::FramePlan plan;
        const double planned =
            1e3 * Time(1, [&] { plan = nacre::MakePlan(scene, settings, &prepared[i]); })[0];
        nacre::RenderStats stats;
        nacre::RenderImage(plan, settings, &stats);
        if (turn == 0) {
          built = planned;
        } else {
          view[i].push_back(planned);
          rays[i].push_back(1e3 * stats.seconds(nacre::Stage::kIntersect));
        }
      }
    }
    const nacre::CameraWork work = nacre::EstimateCameraWork(
        scene, nacre::MakeCameraFrame(scene.camera, scene.image.width, scene.image.height),
        {0, 0, scene.image.width, scene.image.height});
    const double tiles = MedianOf(view[0]) + MedianOf(rays[0]);
    const double tree = MedianOf(view[1]) + MedianOf(rays[1]);
    std::printf("%8d %7.1f %12.2f %6.1f %12.0f %5.2f %6.1f %6.1f %15.1f %9.0f %11.0f\n", spheres,
                depth, MedianOf(view[0]), MedianOf(rays[0]), built, MedianOf(view[1]),
                MedianOf(rays[1]), tiles - tree, nacre::TreeSaves(work) / 1e6, work.in_cells,
                work.rays);
    std::fflush(stdout);
  }
}

// ---- Images -------------------------------------------------------------------------------------

void DecodePng(const char* path, int count) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  PrintSeconds(Time(count, [&] {
    const std::unique_ptr<spng_ctx, decltype(&spng_ctx_free)> png(spng_ctx_new(0), &spng_ctx_free);
    size_t size = 0;
    spng_set_png_buffer(png.get(), bytes.data(), bytes.size());
    if (spng_decoded_image_size(png.get(), SPNG_FMT_RGB8, &size) != 0) {
      throw std::runtime_error("no PNG file");
    }
    std::vector<unsigned char> pixels(size);
    if (spng_decode_image(png.get(), pixels.data(), size, SPNG_FMT_RGB8, 0) != 0) {
      throw std::runtime_error("a PNG file that cannot be decoded");
    }
  }));
}

void WriteJpeg(const char* from, const char* to) {
  api::ToneMapSettings settings;
  settings.tonemap = "none";
  const std::vector<uint8_t> bytes = api::EncodeJpeg(api::ToneMap(api::Read(from), settings), 90);
  std::ofstream(to, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

void EvaluateBrdf(size_t pairs, int count) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<double> planes[9];
  for (auto& plane : planes) plane.resize(pairs);
  for (size_t i = 0; i < pairs; ++i) {
    planes[2][i] = 1;
    for (size_t vector = 1; vector < 3; ++vector) {
      const double x = normal(random), y = normal(random), z = std::abs(normal(random));
      const double length = std::sqrt(x * x + y * y + z * z);
      planes[3 * vector][i] = x / length;
      planes[3 * vector + 1][i] = y / length;
      planes[3 * vector + 2][i] = z / length;
    }
  }
  const auto vectors = [&](size_t first) {
    return std::array<const double*, 3>{planes[first].data(), planes[first + 1].data(),
                                        planes[first + 2].data()};
  };
  const api::Brdf brdf("conductor", {{"preset", "gold"}, {"roughness", 0.2}});
  PrintSeconds(Time(count, [&] { brdf.Shade({pairs, vectors(0), vectors(3), vectors(6)}); }));
}

void UseTarget(const std::string& name) {
  for (const nacre::Target target : nacre::SupportedTargets()) {
    if (nacre::TargetName(target) == name) return nacre::PinTarget(target);
  }
  throw std::runtime_error("no SIMD target of this machine: " + name);
}

bool Run(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "session" && argc >= 8) {
    RunSession(argv + 2, argc - 2);
  } else if (what == "cancel" && argc == 4) {
    CancelRenders(argv[2], std::atoi(argv[3]));
  } else if (what == "embree" && argc == 4) {
    BuildTriangles(std::atoi(argv[2]), std::atoi(argv[3]));
  } else if (what == "rays" && argc == 4) {
    TraceRays(std::atoi(argv[2]), std::atoi(argv[3]));
  } else if (what == "packets" && argc == 4) {
    UseTarget(argv[2]);
    ComparePackets(std::atoi(argv[3]));
  } else if (what == "clouds" && argc == 6) {
    UseTarget(argv[2]);
    CompareClouds(std::atoi(argv[3]), std::atoi(argv[4]), std::atoi(argv[5]));
  } else if (what == "spng" && argc == 4) {
    DecodePng(argv[2], std::atoi(argv[3]));
  } else if (what == "jpeg" && argc == 4) {
    WriteJpeg(argv[2], argv[3]);
  } else if (what == "brdf" && argc == 4) {
    EvaluateBrdf(static_cast<size_t>(std::atoi(argv[2])), std::atoi(argv[3]));
  } else {
    return false;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (Run(argc, argv)) return 0;
    std::fputs("usage: the first lines of bench/waiting_bench.cc\n", stderr);
    return 64;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "waiting_bench: %s\n", error.what());
    return 70;
  }
}
