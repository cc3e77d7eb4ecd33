// SPDX-License-Identifier: Apache-2.0
// scene_io/tiny_gltf_model.h: tinygltf's data structures, without its image decoders and without
// any access to files. What it reads is not to be trusted: gltf_document.h.
#pragma once

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#include <tiny_gltf.h>
