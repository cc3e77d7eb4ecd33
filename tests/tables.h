// SPDX-License-Identifier: Apache-2.0
// tests/tables.h: reads the reference tables and states the rule that most of them are judged by.
#pragma once

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "base/vec.h"

namespace nacre {

// The table `name`.json: from the folder that the environment variable NACRE_TABLES names, so
// that other tables of the same form run through the same tests without a rebuild; a file missing
// there comes from the copy in tests/tables.
inline nlohmann::json LoadTable(const std::string& name) {
  std::filesystem::path path = std::filesystem::path(NACRE_SOURCE_DIR) / "tests/tables";
  if (const char* folder = std::getenv("NACRE_TABLES")) {
    if (std::filesystem::exists(std::filesystem::path(folder) / (name + ".json"))) path = folder;
  }
  std::ifstream file(path / (name + ".json"));
  if (!file) throw std::runtime_error("no table " + name + " in " + path.string());
  return nlohmann::json::parse(file);
}

// A reference value, which tables hold as a decimal string of 20 to 30 digits. Numbers below
// double's range are denormals or 0, which std::stod refuses.
inline double TableNumber(const nlohmann::json& value) {
  if (!value.is_string()) return value.get<double>();
  const auto text = value.get<std::string>();
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0') throw std::runtime_error("\"" + text + "\" is no number");
  return number;
}

inline Vec3d TableVector(const nlohmann::json& value) {
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

// Half an ulp of 1 in float and in double.
inline constexpr double kHalfUlpFloat = 0x1p-24;
inline constexpr double kHalfUlpDouble = 0x1p-53;

// The conditioned rule: |got - ref| <= 8 u (cond + 8) |ref| + tiny, got finite and >= 0. `cond` is
// the sum over inputs of |x df/dx| / |f|, so 8 u cond |ref| is what eight roundings of the inputs
// do to the result, and 8 u 8 |ref| what 64 roundings of it do.
inline bool PassesConditionedRule(double got, double reference, double cond, double u) {
  const double tiny = u == kHalfUlpFloat ? 1.2e-38 : 1e-300;
  return std::isfinite(got) && got >= 0 &&
         std::abs(got - reference) <= 8 * u * (cond + 8) * std::abs(reference) + tiny;
}

}  // namespace nacre
