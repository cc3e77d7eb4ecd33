// SPDX-License-Identifier: Apache-2.0
// shading/sheen_kernel.cc: a layer of fuzz over what hits reflect of a light. In double: its lobe
// stands at the horizon, where products with n.l leave the range of float. Scalar twin:
// scalar_material.cc.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/sheen_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/sheen-inl.h"
#include "shading/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
using HalfFloatTag = hn::Rebind<float, D>;  // as many floats as a vector has doubles

HWY_INLINE V Promoted(const AlignedArray<float>& from, size_t i) {
  return hn::PromoteTo(D(), hn::LoadU(HalfFloatTag(), from.data() + i));
}

HWY_INLINE Vec3V<V> Promoted(const Soa3<float>& from, size_t i) {
  return {Promoted(from.x, i), Promoted(from.y, i), Promoted(from.z, i)};
}

// Directions that were rounded to float, of length 1 again.
HWY_INLINE Vec3V<V> UnitOf(const Vec3V<V>& v) {
  const D d;
  const V squared = FusedDot(v, v);
  const auto some = hn::Gt(squared, hn::Zero(d));
  const V one = hn::Set(d, 1.0);
  return Scale(v, hn::Div(one, hn::Sqrt(hn::IfThenElse(some, squared, one))));
}

// light * share, but 0 for a share of 0 where the light has overflowed: infinity times 0 is NaN.
HWY_INLINE V Left(V light, V share) {
  const D d;
  return hn::IfThenElseZero(hn::Gt(share, hn::Zero(d)), hn::Mul(light, share));
}

// The sheen of all hits, or of each.
class SheenAt {
 public:
  explicit SheenAt(const SheenUniforms& uniforms)
      : uniforms_(uniforms), all_(BroadcastCharlie(D(), uniforms.sheen.charlie)) {}

  HWY_INLINE CharlieV<V> CharlieOf(size_t i) const {
    if (uniforms_.roughness == nullptr) return all_;
    return MakeCharlie(D(), hn::LoadU(D(), uniforms_.roughness + i));
  }
  HWY_INLINE Vec3V<V> ColorOf(size_t i) const {
    const D d;
    const Rgb& color = uniforms_.sheen.color;
    if (uniforms_.roughness == nullptr) {
      return {hn::Set(d, color.x), hn::Set(d, color.y), hn::Set(d, color.z)};
    }
    return {hn::LoadU(d, uniforms_.color[0] + i), hn::LoadU(d, uniforms_.color[1] + i),
            hn::LoadU(d, uniforms_.color[2] + i)};
  }

 private:
  const SheenUniforms& uniforms_;
  CharlieV<V> all_;
};

void CoverBySheenT(const SheenUniforms& uniforms, const ShadeRange& range,
                   const ReflectedRadiance& below) {
  const D d;
  const HalfFloatTag df;
  const V zero = hn::Zero(d);
  const LightOnBatch& on_batch = range.lights[0];
  const LightBatch& light = *on_batch.evaluated;
  const Rgb& light_color = on_batch.light->color;
  const SheenAt sheen(uniforms);
  ReflectedRadiance& to = *range.radiance;
  const bool added = range.leaves == Leaves::kAddedParts;
  const bool parts = range.leaves != Leaves::kSum;
  const bool sums = range.leaves == Leaves::kSum || range.leaves == Leaves::kPartsAndSum;
  for (size_t i = range.begin; i < range.end; i += hn::Lanes(d)) {
    const auto mask = hn::FirstN(df, range.end - i);
    const Vec3V<V> normal = UnitOf(Promoted(range.surface.normal, i));
    AnglesV<V> angles = ComputeAngles(d, normal, UnitOf(Promoted(light.to_light, i)),
                                      UnitOf(Promoted(range.surface.to_view, i)));
    angles.n_dot_v = hn::Max(angles.n_dot_v, zero);
    const V n_dot_l = hn::Max(angles.n_dot_l, zero);
    const CharlieV<V> charlie = sheen.CharlieOf(i);
    const Vec3V<V> color = sheen.ColorOf(i);
    const SheenScaleV<V> scale =
        ScaleSheen(d, hn::Max(hn::Max(color.x, color.y), color.z),
                   CharlieAlbedo(d, charlie, angles.n_dot_v), CharlieAlbedo(d, charlie, n_dot_l));
    const V irradiance = hn::Mul(Promoted(light.irradiance, i), n_dot_l);
    const V lobe = hn::Mul(hn::Mul(CharlieLobe(d, charlie, angles), irradiance), scale.lobe);
    const Vec3V<V> diffuse = Promoted(below.diffuse, i), specular = Promoted(below.specular, i);
    const auto put = [&](V color_of, double light_of, V diffuse_of, V specular_of,
                         AlignedArray<float>& to_diffuse, AlignedArray<float>& to_specular,
                         AlignedArray<float>& to_sum) HWY_ATTR {
      const V of_sheen = hn::Mul(hn::Mul(lobe, color_of), hn::Set(d, light_of));
      const V all_diffuse = hn::Add(Left(diffuse_of, scale.below), of_sheen);
      const V all_specular = Left(specular_of, scale.below);
      const auto part = [&](V value, AlignedArray<float>& array) HWY_ATTR {
        const auto rounded = hn::DemoteTo(df, value);
        const auto before = added ? hn::LoadU(df, array.data() + i) : hn::Zero(df);
        hn::BlendedStore(hn::Add(before, rounded), mask, df, array.data() + i);
        return rounded;
      };
      if (parts) {
        const auto d_part = part(all_diffuse, to_diffuse);
        const auto s_part = part(all_specular, to_specular);
        if (sums) hn::BlendedStore(hn::Add(d_part, s_part), mask, df, to_sum.data() + i);
      } else {
        const auto sum = hn::Add(hn::DemoteTo(df, all_diffuse), hn::DemoteTo(df, all_specular));
        hn::BlendedStore(sum, mask, df, to_sum.data() + i);
      }
    };
    put(color.x, light_color.x, diffuse.x, specular.x, to.diffuse.x, to.specular.x, to.sum.x);
    put(color.y, light_color.y, diffuse.y, specular.y, to.diffuse.y, to.specular.y, to.sum.y);
    put(color.z, light_color.z, diffuse.z, specular.z, to.diffuse.z, to.specular.z, to.sum.z);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(CoverBySheenT);

void CoverBySheen(const SheenUniforms& uniforms, const ShadeRange& range,
                  const ReflectedRadiance& below) {
  HWY_DYNAMIC_DISPATCH(CoverBySheenT)(uniforms, range, below);
}
}  // namespace nacre
#endif
