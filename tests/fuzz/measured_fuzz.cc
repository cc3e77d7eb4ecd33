// SPDX-License-Identifier: Apache-2.0
// tests/fuzz/measured_fuzz.cc: files of measured BRDFs. What is read is evaluated and sampled:
// tables must not be left, whatever is in them.
#include <cmath>
#include <cstdlib>

#include "brdf/measured.h"
#include "fuzz/fuzz_input.h"
#include "fuzz/targets.h"
#include "scene_io/measured_file.h"
#include "scene_io/merl_file.h"
#include "scene_io/rgl_file.h"

namespace nacre {
namespace {

void UseMeasured(const MeasuredBrdf& brdf) {
  const Basis<double> frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const double height : {1.0, 0.6, 0.01}) {
    const Vec3d v(std::sqrt(1 - height * height) * 0.6, std::sqrt(1 - height * height) * -0.8,
                  height);
    for (const double u : {0.0, 0.3, 0.999}) {
      const Vec3d l = SampleMeasured(brdf, frame, v, u, 1 - u);
      const Rgb value = EvaluateMeasured(brdf, MeasuredInterpolation::kLinear, frame, l, v);
      const double pdf = MeasuredPdf(brdf, frame, v, l);
      for (const double number : {value.x, value.y, value.z, pdf}) {
        if (!(number >= 0)) std::abort();
      }
    }
  }
}

}  // namespace

// A whole table has 35 MB: fuzzers get its header, and a byte that is repeated for the rest.
void FuzzMerl(std::string_view bytes) {
  ReadOrRefuse([&] { CheckMerlHeader(bytes, bytes.size(), "a.binary"); });
  ReadOrRefuse([&] {
    if (bytes.size() < kMerlHeaderBytes + 8) return;
    CheckMerlHeader(bytes, kMerlBytes, "a.binary");
    std::string whole(bytes.substr(0, kMerlHeaderBytes));
    while (whole.size() < kMerlBytes) whole += bytes.substr(kMerlHeaderBytes, 8);
    const MerlTable table = ReadMerl(whole, "a.binary");
    for (const float value : table.rgb) {
      if (!(value >= 0)) std::abort();
    }
  });
}

void FuzzRgl(std::string_view bytes) {
  ReadOrRefuse([&] {
    if (!IsTensorFile(bytes)) ReadRgl(bytes, "a.bsdf");  // which refuses it
    UseMeasured(*ReadMeasured(bytes, "a.bsdf"));
  });
}

}  // namespace nacre
