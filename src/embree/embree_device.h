// SPDX-License-Identifier: Apache-2.0
// embree/embree_device.h: Embree's devices, which are kept from render to render: their instruction
// set and their errors.
#pragma once

#include <memory>

#include "embree/embree_api.h"

namespace nacre {

// A device of the active target, for one user at a time. It is taken from a store of devices that
// the process keeps, and returned there: creating a device takes milliseconds, and destroying one
// leaks 7 KB in TBB 2021.8.
class EmbreeDevice {
 public:
  // Throws Error (kInternal) if Embree lacks the target's instruction set.
  EmbreeDevice();
  ~EmbreeDevice();
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;

  RTCDevice get() const;
  int packet_width() const;  // of the widest packets that it traverses natively

  // Throws the first error that Embree reported since this was made, from any of its threads.
  void ThrowIfFailed();

  struct Kept;

 private:
  std::unique_ptr<Kept> kept_;
};

}  // namespace nacre
