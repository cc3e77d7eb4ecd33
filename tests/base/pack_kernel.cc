// SPDX-License-Identifier: Apache-2.0
// tests/base/pack_kernel.cc: the call behind pack_kernel.h.
#include "base/pack_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "base/pack_kernel.cc"
#include "hwy/foreach_target.h"

#include "hwy/highway.h"

#include "base/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace nacre {
namespace HWY_NAMESPACE {

PackedNumbers PackAndUnpackT(const std::vector<float>& x) {
  const ShadeTag<float> d;  // of the most lanes that any kernel packs at a time
  const size_t lanes = hn::Lanes(d), end = (x.size() + lanes - 1) / lanes * lanes;
  std::vector<float> from = x;
  from.resize(end);
  PackedNumbers numbers{std::vector<float>(end), std::vector<float>(end)};
  std::vector<uint8_t> kept(end + 7);
  size_t count = 0, bytes = 0;
  for (size_t i = 0; i < end; i += lanes, bytes += LaneBytes(d)) {
    const auto v = hn::LoadU(d, from.data() + i);
    count += Pack(d, v, hn::Gt(v, hn::Zero(d)), numbers.packed.data() + count, &kept[bytes]);
  }
  const float* packed = numbers.packed.data();
  bytes = 0;
  for (size_t i = 0; i < end; i += lanes, bytes += LaneBytes(d)) {
    hn::StoreU(Unpack(d, &kept[bytes], &packed), d, numbers.unpacked.data() + i);
  }
  numbers.packed.resize(count);
  numbers.unpacked.resize(x.size());
  return numbers;
}

}  // namespace HWY_NAMESPACE
}  // namespace nacre
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace nacre {
HWY_EXPORT(PackAndUnpackT);

PackedNumbers PackAndUnpack(const std::vector<float>& x) {
  return HWY_DYNAMIC_DISPATCH(PackAndUnpackT)(x);
}
}  // namespace nacre
#endif
