// SPDX-License-Identifier: Apache-2.0
#include "brdf/presets.h"

namespace nacre {
namespace {

// Sources of the numbers, and the wavelengths that each channel stands for:
// - silver, iron, aluminium: refractiveindex.info at 650, 550 and 450 nm, one wavelength a channel.
// - gold: the measured spectrum that pbrt and Mitsuba ship, averaged over each channel's response.
// - copper: Hagemann, Gudat and Kunz 1974 (DESY SR-74/7) at 652.5 and 442.8 nm; green is the value
//   of the project's Fresnel table, which lies near their 520 nm.
// - dielectrics: the sodium line, 589 nm; glass is an idealised crown. Dispersion is left out.
constexpr IndexPreset kPresets[] = {
    {"gold", InterfaceKind::kConductor, {0.143, 0.375, 1.442}, {3.983, 2.386, 1.603}},
    {"silver", InterfaceKind::kConductor, {0.159, 0.145, 0.135}, {3.929, 3.190, 2.381}},
    {"copper", InterfaceKind::kConductor, {0.214, 1.102, 1.169}, {3.670, 2.583, 2.360}},
    {"iron", InterfaceKind::kConductor, {2.912, 2.950, 2.585}, {3.089, 2.932, 2.767}},
    {"aluminium", InterfaceKind::kConductor, {1.346, 0.965, 0.618}, {7.475, 6.400, 5.303}},
    {"glass", InterfaceKind::kDielectric, {1.5, 1.5, 1.5}, {0, 0, 0}},
    {"water", InterfaceKind::kDielectric, {1.333, 1.333, 1.333}, {0, 0, 0}},
    {"diamond", InterfaceKind::kDielectric, {2.417, 2.417, 2.417}, {0, 0, 0}},
};

}  // namespace

std::span<const IndexPreset> IndexPresets() { return kPresets; }

const IndexPreset* FindIndexPreset(std::string_view name) {
  for (const IndexPreset& preset : kPresets) {
    if (preset.name == name) return &preset;
  }
  return nullptr;
}

}  // namespace nacre
