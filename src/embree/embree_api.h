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

// Calls `query`, an rtcIntersect or rtcOccluded function. `rays` leads to its packet of rays.
template <class Rays>
void Query(void (*query)(const int*, RTCScene, EmbreeContext*, Rays*), const int* valid,
           RTCScene scene, EmbreeContext* context, void* rays) {
  query(valid, scene, context, static_cast<Rays*>(rays));
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

inline void InitArguments(RTCIntersectArguments* arguments) {
  rtcInitIntersectArguments(arguments);
}
inline void InitArguments(RTCOccludedArguments* arguments) { rtcInitOccludedArguments(arguments); }

template <class Rays, class Arguments>
void Query(void (*query)(const int*, RTCScene, Rays*, Arguments*), const int* valid, RTCScene scene,
           EmbreeContext* context, void* rays) {
  Arguments arguments;
  InitArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  arguments.context = context;
  query(valid, scene, static_cast<Rays*>(rays), &arguments);
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

inline void IntersectPacket(int width, const int* valid, RTCScene scene, EmbreeContext* context,
                            RTCRayHit16* rays) {
  switch (width) {
    case 4:
      return Query(&rtcIntersect4, valid, scene, context, rays);
    case 8:
      return Query(&rtcIntersect8, valid, scene, context, rays);
    default:
      return Query(&rtcIntersect16, valid, scene, context, rays);
  }
}

inline void OccludedPacket(int width, const int* valid, RTCScene scene, EmbreeContext* context,
                           RTCRayHit16* rays) {
  switch (width) {
    case 4:
      return Query(&rtcOccluded4, valid, scene, context, rays);
    case 8:
      return Query(&rtcOccluded8, valid, scene, context, rays);
    default:
      return Query(&rtcOccluded16, valid, scene, context, rays);
  }
}

}  // namespace nacre
