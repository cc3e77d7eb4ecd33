// texture/sample_kernel.cc: the loop behind sample_kernel.h.
#include "texture/sample_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texture/sample_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "texture/sample-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

void SampleTextureT(const MipChain& image, const SampleSettings& settings,
                    const SamplePoints& points, int channels, float* const* to) {
  const hn::ScalableTag<double> d;
  const TexelFloatTag<decltype(d)> df;
  const bool mips = settings.filter == TextureFilter::kTrilinear;
  for (size_t i = 0; i < points.count; i += hn::Lanes(d)) {
    auto level = hn::Zero(df);
    if (mips) {
      const auto& f = points.footprint;
      const auto load = [&](const float* from) HWY_ATTR { return hn::LoadU(df, from + i); };
      level = MipLevelOf(d, image,
                         TextureFootprint<decltype(level)>{load(f.du_dx), load(f.dv_dx),
                                                           load(f.du_dy), load(f.dv_dy)});
    }
    SampleImage(d, image, settings, level, hn::LoadU(d, points.u + i), hn::LoadU(d, points.v + i),
                channels, [&](int c, auto value) HWY_ATTR { hn::StoreU(value, df, to[c] + i); });
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(SampleTextureT);

void SampleTexture(const MipChain& image, const SampleSettings& settings,
                   const SamplePoints& points, int channels, float* const* to) {
  HWY_DYNAMIC_DISPATCH(SampleTextureT)(image, settings, points, channels, to);
}
}  // namespace nacre
#endif
