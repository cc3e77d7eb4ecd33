// SPDX-License-Identifier: Apache-2.0
#include "render/hits_plan.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include <fmt/format.h>

#include "base/parallel.h"
#include "base/target.h"
#include "render/camera_cost.h"
#include "render/mesh_windows.h"
#include "scene/primitives.h"
#include "visibility/box_trees.h"
#include "visibility/sphere_bins.h"

namespace nacre {
namespace {

// True only if every camera ray starts outside every sphere, by far more than the rounding errors
// of the intersection tests. Then the camera sees spheres from outside only, and a sphere never
// shadows its own points that face a light.
bool RaysStartOutside(const Scene& scene, const Intersector& intersector, int threads) {
  if (scene.camera.projection == Projection::kPerspective) return intersector.EyeIsOutside();
  // Orthographic: each sphere is in front of the plane in which the rays start, or behind it.
  const Vec3d forward = (scene.camera.look_at - scene.camera.position).normalized();
  const double pixel = scene.camera.height / scene.image.height;
  const double plane = pixel * (scene.image.height + scene.image.width);
  constexpr size_t kBlock = size_t{1} << 14;
  std::atomic<bool> outside = true;
  ParallelForBlocks(scene.spheres.size(), kBlock, threads, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const Sphere& sphere = scene.spheres[i];
      const Vec3d offset = sphere.center - scene.camera.position;
      const double margin = sphere.radius * 1e-9 + 1e-12 * (offset.length() + plane);
      if (!(std::abs(offset.dot(forward)) > sphere.radius + margin)) outside = false;
    }
  });
  return outside;
}

std::string DescribeShapes(const Scene& scene) {
  return fmt::format("{} spheres, {} triangles; exact hits in double on {}", scene.spheres.size(),
                     CountTriangles(scene), TargetName(ActiveTarget()));
}

// A key of the material properties that decide where meshes exist: holes and single-sidedness, for
// the materials that have any, and the version of the textures if there are opacity maps.
ViewKey KeyOfSurfaces(const Scene& scene, const PreparedScene& prepared) {
  ViewKey key;
  if (scene.meshes.empty()) return key;
  key.numbers.push_back(scene.image.culling ? 1 : 0);
  const Material usual;
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& material = scene.materials[i];
    if (material.opacity_map.valid()) key.parts = prepared.versions.Of(ScenePart::kTextures);
    if (material.opacity == usual.opacity && material.opacity_cutoff == usual.opacity_cutoff &&
        !material.opacity_map.valid() && !material.single_sided) {
      continue;
    }
    key.numbers.insert(
        key.numbers.end(),
        {static_cast<double>(i), material.opacity, material.opacity_cutoff,
         static_cast<double>(material.opacity_map.index), material.single_sided ? 1.0 : 0.0});
  }
  return key;
}

// A key of results that also depend on the view: the intersector itself depends only on the shapes.
ViewKey KeyOfView(const PreparedScene& prepared, uint64_t made, std::vector<double> numbers) {
  return ViewKey{made, prepared.versions.Of(ScenePart::kCamera | ScenePart::kImage),
                 std::move(numbers)};
}

void Report(const RenderSettings& settings, double done) {
  if (settings.on_plan_progress) settings.on_plan_progress(done);
}

// Returns the intersector of an earlier plan where that can follow the camera, or a few spheres
// that have changed; else a new one.
std::shared_ptr<Intersector> FindIntersector(const Scene& scene, const RenderSettings& settings,
                                             PreparedScene* prepared) {
  // Lets a camera move around what it looks at, and somewhat away from it.
  constexpr double kOrbit = 2.5;
  const Vec3d& eye = scene.camera.position;
  const bool shells = settings.intersector == IntersectorChoice::kShells;
  ViewKey key = KeyOfSurfaces(scene, *prepared);
  key.numbers.push_back(shells ? 1 : 0);
  Kept<ViewKey, std::shared_ptr<Intersector>>& kept = prepared->intersector;
  if (kept.IsUpToDate(key)) {
    kept.Forget();  // an exception in what follows would leave it half updated
    if (prepared->intersector_shapes == prepared->shapes_made) {
      if (kept.value->MoveTo(scene, eye)) kept.Set(key, kept.value);
    } else if (kept.value->ChangeSpheres(scene, eye)) {
      kept.Set(key, kept.value);
      // Camera bins that took too much memory may fit now.
      if (!prepared->camera_bins.value) prepared->camera_bins.Forget();
    }
  }
  prepared->intersector_shapes = prepared->shapes_made;
  return kept.Get(key, [&] {
    ++prepared->intersectors_made;
    const double reach =
        prepared->for_one_plan ? 0 : kOrbit * (scene.camera.look_at - eye).length();
    const IntersectorSettings how{
        .threads = settings.threads, .tree = false, .shells = shells, .eye_reach = reach};
    return std::make_shared<Intersector>(scene, eye, how);
  });
}

}  // namespace

TracedShapes PrepareShapes(const Scene& scene, const RenderSettings& settings,
                           const CameraFrame& camera, PreparedScene* prepared) {
  TracedShapes shapes;
  shapes.primitives = NumberPrimitives(scene);
  shapes.camera = camera;
  shapes.camera_extent = SumOfAbs(scene.camera.position);
  if (scene.spheres.empty() && CountTriangles(scene) == 0) return shapes;
  shapes.intersector = FindIntersector(scene, settings, prepared);
  shapes.eye_outside = prepared->eye_outside.Get(
      KeyOfView(*prepared, prepared->shapes_made, {}),
      [&] { return RaysStartOutside(scene, *shapes.intersector, settings.threads); });
  Report(settings, 0.15);
  return shapes;
}

TracePlan PlanTrace(const Scene& scene, const RenderSettings& settings, const TracedShapes& shapes,
                    const Window& window, const PixelSampler& sampler, PreparedScene* prepared,
                    Explanation* why) {
  TracePlan plan;
  if (shapes.intersector == nullptr) {
    why->items.push_back(
        {"intersector", false, "the scene has no shapes: every pixel is background"});
    return plan;
  }
  const CameraFrame& camera = shapes.camera;
  const bool nested = shapes.intersector->SpheresAreNested();
  const char* const tree_asked_for = TreeAskedFor(settings.intersector);
  const bool may_tile = tree_asked_for == nullptr && !scene.spheres.empty() && !nested;
  const double sample_margin = std::max(scene.image.filter.width / 2 - 0.5, 0.0);
  const bool adaptive = settings.max_error > 0;
  plan.mesh_windows =
      prepared->mesh_windows.Get(KeyOfView(*prepared, prepared->shapes_made, {}),
                                 [&] { return FindMeshWindows(scene, camera, sample_margin); });
  plan.tile_rays = adaptive ? TileRays::kAny : TileRays::kSamples;
  // Adaptive sampling reads footprints and outlines from the bins even if a BVH traces the rays,
  // because bits must not depend on the intersector. It bins the whole frame, because they must not
  // depend on the region either, whose bins may fit into memory where the frame's do not.
  const Window binned =
      adaptive ? ExtendToCells({0, 0, scene.image.width, scene.image.height}) : window;
  const bool centers = sampler.centered && !adaptive;
  const double margin = centers ? kPixelCenterMargin : sample_margin;
  const ViewKey bins =
      KeyOfView(*prepared, prepared->intersectors_made,
                {static_cast<double>(binned.x0), static_cast<double>(binned.y0),
                 static_cast<double>(binned.x1), static_cast<double>(binned.y1), margin});
  CameraWork work;
  bool tree_pays_off = false;
  if (may_tile && !adaptive && settings.intersector == IntersectorChoice::kAuto &&
      EmbreeVersion() != nullptr) {
    work = EstimateCameraWork(scene, camera, window);
    work.to_bin = !prepared->camera_bins.IsUpToDate(bins);
    double& lost = prepared->lost_to_tiles.Get({prepared->shapes_made, {}, {}}, [] { return 0.0; });
    tree_pays_off = TreePaysOff(work, shapes.intersector->HasTree(), &lost);
  }
  const bool want_tiles = may_tile && !tree_pays_off;
  if (want_tiles || adaptive) {
    plan.binned = prepared->camera_bins.Get(
        bins, [&] { return shapes.intersector->BinForCamera(camera, binned, margin); });
    plan.by_bins = want_tiles && plan.binned;
  }
  why->items.push_back(
      {"intersector tiles, for camera rays", plan.by_bins,
       plan.by_bins ? "spheres binned to 16x16 pixels need no tree: " + DescribeShapes(scene)
       : tree_pays_off
           ? fmt::format("a ray passes about {:.3g} spheres: in such a cloud a tree is faster",
                         work.depth)
       : want_tiles ? fmt::format("the bins would not fit {} MiB", kMaxCameraBinBytes >> 20)
       : scene.spheres.empty() ? "there are no spheres"
       : nested                ? kNestedSpheres
                               : tree_asked_for});
  Report(settings, 0.4);
  return plan;
}

void BuildTrees(const TracedShapes& shapes, const TracePlan& trace, bool for_shadows,
                const RenderSettings& settings, Explanation* why) {
  Intersector* const intersector = shapes.intersector.get();
  if (intersector == nullptr) return;
  const Scene& scene = *shapes.primitives.scene;
  const bool triangles_apart = trace.by_bins && CountTriangles(scene) > 0;
  if (!trace.by_bins || for_shadows) intersector->BuildTree(settings.cancel);
  if (triangles_apart) intersector->BuildTriangleTree(settings.cancel);
  const bool used = !trace.by_bins || triangles_apart || for_shadows;
  const char* const kind = !intersector->HasShells()   ? "Embree's, "
                           : CountTriangles(scene) > 0 ? "of shells, Embree's of the triangles, "
                                                       : "of shells, ";
  const std::string use = !trace.by_bins ? "for all rays: " + DescribeShapes(scene)
                          : triangles_apart && for_shadows
                              ? "for camera rays to triangles, and for shadow rays"
                          : triangles_apart ? "for camera rays to triangles"
                                            : "for shadow rays";
  why->items.push_back(
      {"intersector tree", used, used ? kind + use : "nothing is left for it: none is built"});
}

}  // namespace nacre
