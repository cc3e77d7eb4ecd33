// SPDX-License-Identifier: Apache-2.0
// tests/fuzz/tiny_obj_loader.cc: tinyobjloader's code, compiled with libFuzzer's counters.
#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>
