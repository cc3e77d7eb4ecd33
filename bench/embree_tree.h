// SPDX-License-Identifier: Apache-2.0
// bench/embree_tree.h: bare Embree, as what nacre is held against: a device and trees that release
// themselves.
#pragma once

#include <memory>

#include "embree/embree_api.h"

namespace nacre {

struct ReleaseDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct ReleaseScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DevicePointer = std::unique_ptr<RTCDeviceTy, ReleaseDevice>;
using ScenePointer = std::unique_ptr<RTCSceneTy, ReleaseScene>;

inline DevicePointer MakeDevice() {
  return DevicePointer(rtcNewDevice("verbose=0,set_affinity=0"));
}

// A tree of one geometry, which it takes.
inline ScenePointer BuildTree(RTCGeometry geometry, RTCDevice device) {
  ScenePointer tree(rtcNewScene(device));
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(tree.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(tree.get());
  return tree;
}

}  // namespace nacre
