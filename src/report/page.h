// SPDX-License-Identifier: Apache-2.0
// report/page.h: one HTML file that holds all that it shows: pictures, figures, style and script.
// It asks no server for anything, and its policy forbids it to.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace nacre {

std::string Base64(std::span<const uint8_t> bytes);

// Text between tags or in quoted attributes.
std::string EscapeHtml(std::string_view text);

// A digest, given in hexadecimal, as a Content-Security-Policy names what it allows:
// "sha256-...".
std::string PolicySource(std::string_view sha256);

// JSON inside a <script>, its texts as PrintableLines() has them.
std::string ScriptJson(const nlohmann::ordered_json& data);

// Puts values in the place of {{names}}; what they hold is not looked at again.
using PageValues = std::vector<std::pair<std::string_view, std::string_view>>;
std::string FillPage(std::string_view text, const PageValues& values);

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
