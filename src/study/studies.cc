// SPDX-License-Identifier: Apache-2.0
// study/studies.cc: the list of the studies, with their questions.
#include "study/study.h"

namespace nacre {
namespace {

constexpr StudyEntry kStudies[] = {
    {"components", "Ambient, diffuse and specular",
     "Render a sphere three times, showing only the ambient, diffuse, and specular components. How "
     "does the shininess exponent affect each?",
     StudyComponents},
    {"blinn-exponent", "Blinn's exponent for Phong's",
     "What Blinn-Phong exponent approximately matches a Phong exponent of 64?", StudyBlinnExponent},
    {"interpolation", "Flat, Gouraud and Phong interpolation",
     "Render a low-polygon sphere with flat, Gouraud, and Phong interpolation. At what polygon "
     "count does the Gouraud-shaded sphere begin to look acceptably smooth?",
     StudyInterpolation},
    {"grid", "Roughness and metallic",
     "Create a 5x5 grid of spheres varying roughness and metallic from 0 to 1. Why do fully "
     "metallic, fully smooth spheres look mirror-like while rough ones look like brushed metal?",
     StudyGrid},
    {"fresnel", "Fresnel's effect",
     "Plot the Schlick Fresnel function for F0 = 0.04 and F0 = 0.9. At what angle does a "
     "dielectric surface become 50 % reflective?",
     StudyFresnel},
    {"energy", "Energy conservation",
     "For the Phong model with kd = 0.8 and ks = 0.5, show that the total reflected light can "
     "exceed the incoming light. Then show that the PBR model does not have this problem.",
     StudyEnergy},
    {"precision", "What rounding does",
     "How far from the truth are hits of distant spheres and highlights of smooth surfaces, in "
     "float and in double, by the textbook's formulas and by nacre's?",
     StudyPrecision},
    {"tonemap", "Tone operators", "What do the tone operators make of the same HDR picture?",
     StudyTonemap},
    {"anisotropy", "Brushed metal",
     "What do formats mean by anisotropy, and what does it do to highlights and to energy?",
     StudyAnisotropy},
    {"thin-film", "Thin films",
     "How far are approximations of thin films from the integral over the spectrum?",
     StudyThinFilm},
    {"sheen", "Two kinds of fuzz",
     "How do Charlie's sheen, which glTF names, and the fuzz of Zeltner et al., which OpenPBR "
     "names, differ?",
     StudySheen},
    {"layers", "Rules for layers",
     "How far are OpenPBR's rules for coats and layers from light that is followed between them: "
     "darkening, roughening, partial coats, scaling by albedo?",
     StudyLayers},
};

}  // namespace

std::span<const StudyEntry> Studies() { return kStudies; }

}  // namespace nacre
