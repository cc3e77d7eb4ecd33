// SPDX-License-Identifier: Apache-2.0
// bench/textbook_kernel.h: the textbook's forms of three models as SIMD kernels, with nacre's light
// and loop around them: what the stable forms cost. Not for use in the renderer.
#pragma once

#include "shading/kernels.h"

namespace nacre {

struct TextbookGgxLight {
  float f0[3], rest[3], diffuse[3];  // F0, 1 - F0 and (1 - F0) diffuse / pi, times light
};
struct TextbookGgxUniforms {
  const TextbookGgxLight* light;
  float alpha2, k;
};

// (n.h)^2 (alpha^2 - 1) + 1 of a normalised h; shadowing as kSchlickDirect. All else is as nacre
// does it: one division for distribution and shadowing, estimates with a step of Newton's.
void ShadeTextbookGgx(const TextbookGgxUniforms& uniforms, const LitHits& lit);
// D F G / (4 n.l n.v) as books have it: the operations of ShadeGgx in scalar_baseline.cc, with its
// divisions and roots.
void ShadeWrittenGgx(const TextbookGgxUniforms& uniforms, const LitHits& lit);
// (r.v)^n as 2^(n log2(r.v)).
void ShadeNaivePhong(const PhongUniforms<float>& uniforms, const LitHits& lit);
// (n.h)^n likewise, of a normalised h.
void ShadeNaiveBlinnPhong(const PhongUniforms<float>& uniforms, const LitHits& lit);

}  // namespace nacre
