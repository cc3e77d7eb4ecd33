// SPDX-License-Identifier: Apache-2.0
// embree/embree_device.h: Embree's devices: which instruction set, what went wrong, and kept
// from render to render.
#pragma once

#include <memory>

#include "embree/embree_api.h"

namespace nacre {

// A device of the active target, for one user at a time. It comes from a store of devices that
// the process keeps, and goes back there: a new one takes milliseconds, and one that goes leaves
// 7 KB behind in TBB 2021.8.
class EmbreeDevice {
 public:
  // Throws Error (kInternal) if Embree lacks the target's instruction set.
  EmbreeDevice();
  ~EmbreeDevice();
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;

  RTCDevice get() const;
  int packet_width() const;  // of the widest packets that it walks natively

  // Throws the first error that Embree reported since this was made, from any of its threads.
  void ThrowIfFailed();

  struct Kept;

 private:
  std::unique_ptr<Kept> kept_;
};

}  // namespace nacre
