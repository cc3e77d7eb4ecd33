// SPDX-License-Identifier: Apache-2.0
// tests/brdf/anisotropic_kernel.cc: the loops over arrays behind anisotropic_kernel.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/anisotropic_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "brdf/anisotropic_albedo-inl.h"
#include "brdf/anisotropic_kernel.h"
#include "brdf/ggx_anisotropic-inl.h"
#include "queries-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

std::vector<AnisotropicAnswer> AskAnisotropicT(const std::vector<AnisotropicQuery>& queries) {
  return AskInPackets<float, AnisotropicAnswer>(queries, [](const auto& packet) {
    const hn::ScalableTag<float> d;
    const auto one = hn::Set(d, 1.0f);
    const auto n = packet.Vector(&AnisotropicQuery::n), t = packet.Vector(&AnisotropicQuery::t);
    const auto l = packet.Vector(&AnisotropicQuery::l), v = packet.Vector(&AnisotropicQuery::v);
    const BasisV<hn::Vec<decltype(d)>> frame{t, FusedCross(n, t), n};
    const auto alpha = MakeGgxAlphas(d, packet.Number(&AnisotropicQuery::alpha_x),
                                     packet.Number(&AnisotropicQuery::alpha_y));
    const auto a = ComputeAngles(d, frame, l, v);
    const auto distribution = GgxDistribution(d, a, alpha);
    const auto l_root = SmithRootOfLight(d, a, alpha), v_root = SmithRootOfView(d, a, alpha);
    packet.Store(distribution, &AnisotropicAnswer::distribution);
    packet.Store(hn::Div(one, VisibilityDenominatorHeightCorrelated(d, a, l_root, v_root, one)),
                 &AnisotropicAnswer::height_correlated);
    packet.Store(hn::Div(one, VisibilityDenominatorSeparable(d, a, l_root, v_root, one)),
                 &AnisotropicAnswer::separable);
    packet.Store(GgxVisiblePdf(d, distribution, a, v_root), &AnisotropicAnswer::pdf);
    packet.Store3(SampleGgxVisible(d, frame, v, alpha, packet.Number(&AnisotropicQuery::u0),
                                   packet.Number(&AnisotropicQuery::u1)),
                  &AnisotropicAnswer::sample);
  });
}

std::vector<FrameAnswer> AskFramesT(const std::vector<FrameQuery>& queries) {
  return AskInPackets<float, FrameAnswer>(queries, [](const auto& packet) {
    const hn::ScalableTag<float> d;
    const auto n = packet.Vector(&FrameQuery::n);
    const auto frame = LobeFrame(d, n, packet.Vector(&FrameQuery::t));
    packet.Store3(frame.x, &FrameAnswer::frame_x);
    packet.Store3(frame.y, &FrameAnswer::frame_y);
    packet.Store3(RotatedTangent(n, frame.x, packet.Number(&FrameQuery::cos),
                                 packet.Number(&FrameQuery::sin)),
                  &FrameAnswer::rotated);
  });
}

template <class Fit, class Curve, class Packet>
void StoreAlbedos(const Fit& fit, const Curve& curve, const CoatedDielectric<double>& dielectric,
                  const Packet& packet) {
  const hn::ScalableTag<float> d;
  const auto x = packet.Vector([](const Vec3f& direction) { return direction; });
  const auto variables = ComputeAlbedoVariables(d, fit.shape, x.z, x.x, x.y);
  const auto loss = AlbedoLoss(d, fit, variables);
  packet.Store(loss, &AnisotropicAlbedoOutput::loss);
  const auto one = hn::Set(d, 1.0f), e = hn::Sub(one, loss);
  packet.Store(AlbedoSchlick(d, fit, e, variables), &AnisotropicAlbedoOutput::schlick);
  const auto mirror =
      FresnelCoatedDielectric(d, variables.n_dot_x, hn::Sub(one, variables.n_dot_x), dielectric);
  packet.Store(AlbedoFresnel(d, curve, e, mirror, variables), &AnisotropicAlbedoOutput::fresnel);
}

std::vector<AnisotropicAlbedoOutput> EvaluateAnisotropicAlbedosT(
    const AnisotropicFresnelFit& fit, const std::vector<Vec3f>& directions) {
  return AskInPackets<float, AnisotropicAlbedoOutput>(directions, [&](const auto& packet) {
    StoreAlbedos(fit.lobe, fit.fresnel, fit.dielectric, packet);
  });
}

std::vector<AnisotropicAlbedoOutput> EvaluateEachAnisotropicAlbedosT(
    const std::vector<AnisotropicFresnelFit>& fits, const std::vector<Vec3f>& directions) {
  return AskInPackets<float, AnisotropicAlbedoOutput>(directions, [&](const auto& packet) {
    constexpr size_t kLanes = 32;
    constexpr size_t kShare = kShareTerms * kKappaTerms, kWidth = kWidthTerms * kKappaTerms;
    constexpr size_t kLobe = 6 + 2 * kShare + kWidth;
    std::vector<float> numbers((kLobe + kShare + kStreakTerms * kKappaTerms) * kLanes);
    for (size_t lane = 0; lane < kLanes; ++lane) {
      const AnisotropicFresnelFit& both = fits[std::min(packet.first + lane, fits.size() - 1)];
      const AnisotropicAlbedoFit& fit = both.lobe;
      float* to = numbers.data() + lane;
      const auto put = [&](float number) {
        *to = number;
        to += kLanes;
      };
      const auto put_all = [&](const auto& polynomials) {
        for (const KappaPolynomial& row : polynomials) {
          for (const float c : row) put(c);
        }
      };
      put(fit.shape.alpha_x);
      put(fit.shape.alpha_y);
      put(fit.shape.mean_square);
      put(fit.shape.ratio_squared);
      put(fit.shape.streak);
      put(fit.shape.scale);
      put_all(fit.loss);
      put_all(fit.schlick);
      put_all(fit.streak);
      put_all(both.fresnel.wider);
      put_all(both.fresnel.streak);
    }
    const auto at = [&](size_t i) { return numbers.data() + i * kLanes; };
    StoreAlbedos(AnisotropicAlbedoFitLanes{{at(0), at(1), at(2), at(3), at(4), at(5)},
                                           {at(6), kLanes},
                                           {at(6 + kShare), kLanes},
                                           {at(6 + 2 * kShare), kLanes}},
                 AnisotropicFresnelCurveLanes{
                     {at(kLobe), kLanes}, {at(kLobe + kShare), kLanes}, fits.front().fresnel.bend},
                 fits.front().dielectric, packet);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(AskAnisotropicT);
HWY_EXPORT(AskFramesT);
HWY_EXPORT(EvaluateAnisotropicAlbedosT);
HWY_EXPORT(EvaluateEachAnisotropicAlbedosT);
std::vector<AnisotropicAnswer> AskAnisotropic(const std::vector<AnisotropicQuery>& queries) {
  return HWY_DYNAMIC_DISPATCH(AskAnisotropicT)(queries);
}
std::vector<FrameAnswer> AskFrames(const std::vector<FrameQuery>& queries) {
  return HWY_DYNAMIC_DISPATCH(AskFramesT)(queries);
}
std::vector<AnisotropicAlbedoOutput> EvaluateAnisotropicAlbedos(
    const AnisotropicFresnelFit& fit, const std::vector<Vec3f>& directions) {
  return HWY_DYNAMIC_DISPATCH(EvaluateAnisotropicAlbedosT)(fit, directions);
}
std::vector<AnisotropicAlbedoOutput> EvaluateAnisotropicAlbedos(
    const std::vector<AnisotropicFresnelFit>& fits, const std::vector<Vec3f>& directions) {
  return HWY_DYNAMIC_DISPATCH(EvaluateEachAnisotropicAlbedosT)(fits, directions);
}
}  // namespace nacre
#endif
