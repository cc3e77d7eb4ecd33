// SPDX-License-Identifier: Apache-2.0
#include "shading/sheen.h"

#include <variant>

namespace nacre {

std::optional<SheenModel> MakeSheen(const Material& material) {
  const auto* model = std::get_if<MetallicRoughnessMaterial>(&material.model);
  if (model == nullptr || IsBlack(model->sheen_color)) return std::nullopt;
  if (IsDeltaLobe(AlphaFromRoughness(model->sheen_roughness))) return std::nullopt;
  return SheenModel{model->sheen_color, MakeCharlie(model->sheen_roughness)};
}

}  // namespace nacre
