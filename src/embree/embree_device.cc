// SPDX-License-Identifier: Apache-2.0
#include "embree/embree_device.h"

#include <algorithm>
#include <cstring>
#include <mutex>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/target.h"

namespace nacre {
namespace {

// Embree's name for the instruction set of a target, and the widest packet that it traverses
// natively.
struct EmbreeTarget {
  const char* isa;
  int packet_width;
};

EmbreeTarget EmbreeTargetFor(Target target) {
  switch (target) {
    case Target::kScalar:
      return {"sse2", 4};
    case Target::kSse4:
      return {"sse4.2", 4};
    case Target::kAvx2:
      return {"avx2", 8};
    case Target::kAvx3:
      return {"avx512", 16};
    case Target::kNeon:
      return {"neon", 4};
  }
  return {"sse2", 4};
}

// The first error that Embree reported, from any of its threads.
class ErrorRecord {
 public:
  // Embree calls this from C, so it must not throw.
  static void Report(void* self, RTCError code, const char* text) noexcept {
    static_cast<ErrorRecord*>(self)->Remember(code, text);
  }

  void ThrowIfAny() {
    const std::lock_guard lock(mutex_);
    if (code_ == RTC_ERROR_NONE) return;
    if (code_ == RTC_ERROR_OUT_OF_MEMORY) {
      throw Error(ExitCode::kInternal, "Embree", "out of memory while building the scene");
    }
    throw Error(ExitCode::kInternal, "Embree", text_);
  }

  bool empty() {
    const std::lock_guard lock(mutex_);
    return code_ == RTC_ERROR_NONE;
  }

 private:
  void Remember(RTCError code, const char* text) {
    const std::lock_guard lock(mutex_);
    if (code == RTC_ERROR_CANCELLED) return;  // it was requested
    if (code_ != RTC_ERROR_NONE) return;
    code_ = code;
    if (text == nullptr) text = "unknown error";
    std::strncpy(text_, text, sizeof(text_) - 1);
  }

  std::mutex mutex_;
  RTCError code_ = RTC_ERROR_NONE;
  char text_[256] = {};  // no std::string, because memory may have run out
};

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
using DevicePointer = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;

// Embree ignores configuration that it does not know, so the result is read back. Its threads are
// not set here: threads=1 would throttle TBB in the whole process.
DevicePointer MakeDevice(Target target) {
  const EmbreeTarget wanted = EmbreeTargetFor(target);
  const std::string config = std::string("isa=") + wanted.isa + ",verbose=0,set_affinity=0";
  DevicePointer device(rtcNewDevice(config.c_str()));
  if (!device) {
    if (rtcGetDeviceError(nullptr) == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    throw Error(ExitCode::kInternal, "Embree", "cannot create a device: " + config);
  }
  const auto native = [&](RTCDeviceProperty property) {
    return rtcGetDeviceProperty(device.get(), property) != 0;
  };
  int width = 4;
  if (native(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED)) width = 8;
  if (native(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) width = 16;
  if (width != wanted.packet_width) {
    throw Error(ExitCode::kInternal, "Embree",
                "this build walks packets of " + std::to_string(width) + " rays where " + config +
                    " calls for " + std::to_string(wanted.packet_width),
                "choose another target, or install an Embree built for this one");
  }
  return device;
}

}  // namespace

struct EmbreeDevice::Kept {
  Target target;
  ErrorRecord errors;  // the device points to it, and is destroyed first
  DevicePointer device;
};

namespace {

// The devices that are not in use. Never destroyed, because at exit Embree may be destroyed first.
struct Store {
  std::mutex mutex;
  std::vector<std::unique_ptr<EmbreeDevice::Kept>> free;
};

Store& TheStore() {
  static auto* const store = new Store;
  return *store;
}

std::unique_ptr<EmbreeDevice::Kept> TakeKept(Target target) {
  Store& store = TheStore();
  const std::lock_guard lock(store.mutex);
  const auto found = std::find_if(store.free.begin(), store.free.end(),
                                  [&](const auto& kept) { return kept->target == target; });
  if (found == store.free.end()) return nullptr;
  std::unique_ptr<EmbreeDevice::Kept> kept = std::move(*found);
  store.free.erase(found);
  return kept;
}

}  // namespace

EmbreeDevice::EmbreeDevice() : kept_(TakeKept(ActiveTarget())) {
  if (kept_) return;
  kept_ = std::make_unique<Kept>();
  kept_->target = ActiveTarget();
  kept_->device = MakeDevice(kept_->target);
  rtcSetDeviceErrorFunction(kept_->device.get(), &ErrorRecord::Report, &kept_->errors);
}

EmbreeDevice::~EmbreeDevice() {
  if (!kept_->errors.empty()) return;  // a device that failed is not kept
  Store& store = TheStore();
  const std::lock_guard lock(store.mutex);
  try {
    store.free.push_back(std::move(kept_));
  } catch (const std::bad_alloc&) {
    // This device is then not kept.
  }
}

RTCDevice EmbreeDevice::get() const { return kept_->device.get(); }

int EmbreeDevice::packet_width() const { return EmbreeTargetFor(kept_->target).packet_width; }

void EmbreeDevice::ThrowIfFailed() { kept_->errors.ThrowIfAny(); }

}  // namespace nacre
