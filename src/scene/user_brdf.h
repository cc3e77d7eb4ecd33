// SPDX-License-Identifier: Apache-2.0
// scene/user_brdf.h: a reflection model that the library's caller has written, as functions over
// batches of directions.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace nacre {

struct UserBrdf {
  using Vectors = std::array<const double*, 3>;  // x, y and z of each
  using Values = std::array<double*, 3>;

  // Unit vectors at `count` points. Light and viewer are above the surface. to_light is null for
  // `sample`, which finds it.
  struct Batch {
    size_t count;
    Vectors normal, to_view, to_light;
  };

  std::string name;  // of the material, for errors
  // The BRDF f(l, v) in 1/sr, by channel, without n.l.
  std::function<void(const Batch&, const Values& rgb)> evaluate;
  // Either both or neither: `sample` maps points (u, v) in [0, 1)^2 to unit directions to light,
  // and `pdf` gives their pdf per solid angle. Sampled directions below the surface count as lost
  // light.
  std::function<void(const Batch&, const double* u, const double* v, const Values& to_light)>
      sample;
  std::function<void(const Batch&, double* pdf)> pdf;
};

using UserBrdfs = std::map<std::string, std::shared_ptr<const UserBrdf>>;  // by material name

}  // namespace nacre
