// SPDX-License-Identifier: Apache-2.0
// scene_io/tiny_gltf_model.cc: tinygltf's code.
#include <fstream>  // which it forgets without file access

#define TINYGLTF_IMPLEMENTATION
#include "scene_io/tiny_gltf_model.h"
