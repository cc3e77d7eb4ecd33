// SPDX-License-Identifier: Apache-2.0
// base/handover.h: tells ThreadSanitizer of data that passes between threads through a library that
// was not built with it (Embree), whose synchronisation it cannot see. In other builds these
// functions do nothing.
//
// The two are a release and an acquire of one key: what was written before HandOver(key) is visible
// after TakeOver(key). They must not claim more ordering than the library provides.
#pragma once

#if defined(__SANITIZE_THREAD__)
#define NACRE_HANDOVER 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define NACRE_HANDOVER 1
#endif
#endif

#ifdef NACRE_HANDOVER
extern "C" {
void __tsan_acquire(void* key);  // NOLINT(bugprone-reserved-identifier)
void __tsan_release(void* key);  // NOLINT(bugprone-reserved-identifier)
}
#endif

namespace nacre {

inline void HandOver([[maybe_unused]] const void* key) {
#ifdef NACRE_HANDOVER
  __tsan_release(const_cast<void*>(key));
#endif
}

inline void TakeOver([[maybe_unused]] const void* key) {
#ifdef NACRE_HANDOVER
  __tsan_acquire(const_cast<void*>(key));
#endif
}

}  // namespace nacre
