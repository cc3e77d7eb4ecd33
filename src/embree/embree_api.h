// SPDX-License-Identifier: Apache-2.0
// embree/embree_api.h: Embree 3 and Embree 4 under one set of names: all differences between the
// two are here. Queries run on packets of 4, 8 or 16 rays, or on one ray.
#pragma once

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

namespace nacre {

#if RTC_VERSION_MAJOR == 3

// Embree passes this unchanged from a query to its callbacks. It is extended by a struct whose
// first member it is.
using EmbreeContext = RTCIntersectContext;

inline void InitContext(EmbreeContext* context) {
  rtcInitIntersectContext(context);
  context->flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
}

inline void IntersectPacket(int width, const int* valid, RTCScene scene, EmbreeContext* context,
                            RTCRayHit16* rays) {
  switch (width) {
    case 4:
      return rtcIntersect4(valid, scene, context, reinterpret_cast<RTCRayHit4*>(rays));
    case 8:
      return rtcIntersect8(valid, scene, context, reinterpret_cast<RTCRayHit8*>(rays));
    default:
      return rtcIntersect16(valid, scene, context, rays);
  }
}

inline void OccludedPacket(int width, const int* valid, RTCScene scene, EmbreeContext* context,
                           RTCRayHit16* rays) {
  switch (width) {
    case 4:
      return rtcOccluded4(valid, scene, context, reinterpret_cast<RTCRay4*>(rays));
    case 8:
      return rtcOccluded8(valid, scene, context, reinterpret_cast<RTCRay8*>(rays));
    default:
      return rtcOccluded16(valid, scene, context, reinterpret_cast<RTCRay16*>(rays));
  }
}

inline void IntersectOne(RTCScene scene, EmbreeContext* context, RTCRayHit* ray) {
  rtcIntersect1(scene, context, ray);
}

inline void OccludedOne(RTCScene scene, EmbreeContext* context, RTCRay* ray) {
  rtcOccluded1(scene, context, ray);
}

#else

using EmbreeContext = RTCRayQueryContext;

inline void InitContext(EmbreeContext* context) { rtcInitRayQueryContext(context); }

inline void IntersectPacket(int width, const int* valid, RTCScene scene, EmbreeContext* context,
                            RTCRayHit16* rays) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  arguments.context = context;
  switch (width) {
    case 4:
      return rtcIntersect4(valid, scene, reinterpret_cast<RTCRayHit4*>(rays), &arguments);
    case 8:
      return rtcIntersect8(valid, scene, reinterpret_cast<RTCRayHit8*>(rays), &arguments);
    default:
      return rtcIntersect16(valid, scene, rays, &arguments);
  }
}

inline void OccludedPacket(int width, const int* valid, RTCScene scene, EmbreeContext* context,
                           RTCRayHit16* rays) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  arguments.context = context;
  switch (width) {
    case 4:
      return rtcOccluded4(valid, scene, reinterpret_cast<RTCRay4*>(rays), &arguments);
    case 8:
      return rtcOccluded8(valid, scene, reinterpret_cast<RTCRay8*>(rays), &arguments);
    default:
      return rtcOccluded16(valid, scene, reinterpret_cast<RTCRay16*>(rays), &arguments);
  }
}

inline void IntersectOne(RTCScene scene, EmbreeContext* context, RTCRayHit* ray) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = context;
  rtcIntersect1(scene, ray, &arguments);
}

inline void OccludedOne(RTCScene scene, EmbreeContext* context, RTCRay* ray) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = context;
  rtcOccluded1(scene, ray, &arguments);
}

#endif

}  // namespace nacre
