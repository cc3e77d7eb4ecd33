// SPDX-License-Identifier: Apache-2.0
// tests/fuzz/shared_folder.cc: the files that fuzzed scenes and models may name: mesh.obj,
// mesh.ply, mesh.mtl, texture.png, floats.pfm and buffer.bin.
#include <array>

#include "fuzz/fuzz_input.h"

namespace nacre {
namespace {

constexpr std::string_view kObj =
    "mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\n"
    "f 1/1 2/2 3/3\nf 1/1 3/2 4/3\n";
constexpr std::string_view kMtl = "newmtl a\nKd 0.5 0.5 0.5\nNs 10\nmap_Kd texture.png\n";
constexpr std::string_view kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

// 2 x 2 pixels, red, green, blue, white.
constexpr std::array<unsigned char, 75> kPng = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
    0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x02, 0x00, 0x00, 0x00, 0xfd,
    0xd4, 0x9a, 0x73, 0x00, 0x00, 0x00, 0x12, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0xf8,
    0xcf, 0xc0, 0xc0, 0x00, 0xc2, 0x0c, 0xff, 0x81, 0x00, 0x00, 0x1f, 0xee, 0x05, 0xfb, 0xf1,
    0xab, 0xba, 0x77, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

}  // namespace

const FuzzFolder& SharedFolder() {
  static const FuzzFolder folder;
  static const bool is_filled = [] {
    folder.Write("mesh.obj", kObj);
    folder.Write("mesh.mtl", kMtl);
    folder.Write("mesh.ply", kPly);
    folder.Write("texture.png", {reinterpret_cast<const char*>(kPng.data()), kPng.size()});
    std::string floats = "PF\n2 1\n-1.0\n";
    folder.Write("floats.pfm", floats.append(2 * 3 * sizeof(float), '\0'));
    folder.Write("buffer.bin", std::string(96, '\0'));
    return true;
  }();
  (void)is_filled;
  return folder;
}

}  // namespace nacre
