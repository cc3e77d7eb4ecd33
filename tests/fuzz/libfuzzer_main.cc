// SPDX-License-Identifier: Apache-2.0
// tests/fuzz/libfuzzer_main.cc: one target for libFuzzer; CMake names it.
#include <cstddef>
#include <cstdint>

#include "fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  nacre::NACRE_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
  return 0;
}
