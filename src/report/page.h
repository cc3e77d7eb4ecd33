// SPDX-License-Identifier: Apache-2.0
// report/page.h: one HTML file that holds all that it shows: pictures, figures, style and script.
// It asks no server for anything, and its policy forbids it to.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace nacre {

std::string Base64(std::span<const uint8_t> bytes);

// Text between tags or in quoted attributes.
std::string EscapeHtml(std::string_view text);

class Page {
 public:
  // Keeps the bytes, deflated; returns the number by which `data` refers to them.
  int AddBlob(std::span<const uint8_t> bytes);

  // `data` is what html/data.js calls REPORT.
  std::string Html(const std::string& title, const std::string& generator,
                   const nlohmann::ordered_json& data) const;

 private:
  std::vector<std::string> blobs_;  // base64
};

}  // namespace nacre
