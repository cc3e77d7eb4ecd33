// SPDX-License-Identifier: Apache-2.0
// tests/fuzz/targets.h: the entries through which a stranger's bytes come in, each as a function of
// the bytes alone. libFuzzer calls one (libfuzzer_main.cc), the replay of found files all
// (replay_main.cc).
#pragma once

#include <string_view>

namespace nacre {

// Each returns when the bytes were read, or refused as they should be. What is neither ends the
// process: errors other than of bad input or usage, other exceptions, empty messages.
void FuzzSceneJson(std::string_view bytes);
void FuzzSetPath(std::string_view bytes);  // lines of "pointer=value", on a scene and on a model
void FuzzObj(std::string_view bytes);      // an OBJ file; after a line "# mtl" its materials
void FuzzPly(std::string_view bytes);
void FuzzSphereFile(std::string_view bytes);  // a .csv, .npy or .ply of a shape "spheres"
void FuzzGltf(std::string_view bytes);
void FuzzGlb(std::string_view bytes);
void FuzzMaterialX(std::string_view bytes);  // a .mtlx; after a line "<!-- included -->" another
void FuzzTextureImage(std::string_view bytes);
void FuzzEnvironmentImage(std::string_view bytes);
void FuzzCompareImage(std::string_view bytes);
void FuzzMerl(std::string_view bytes);       // the header and the first number of a MERL table
void FuzzRgl(std::string_view bytes);        // a .bsdf of EPFL's
void FuzzBrdfTable(std::string_view bytes);  // a .csv, .json or .npy of another program

}  // namespace nacre
