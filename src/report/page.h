// SPDX-License-Identifier: Apache-2.0
// report/page.h: a self-contained HTML file with pictures, figures, style and script. It loads
// nothing from any server, and its policy forbids it.
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

// Escapes text for use between tags or in quoted attributes.
std::string EscapeHtml(std::string_view text);

// Converts a digest in hexadecimal to the form of a Content-Security-Policy: "sha256-...".
std::string PolicySource(std::string_view sha256);

// JSON for a <script>, with PrintableLines() applied to its texts.
std::string ScriptJson(const nlohmann::ordered_json& data);

// Replaces placeholders {{name}} by values; placeholders within values are not replaced.
using PageValues = std::vector<std::pair<std::string_view, std::string_view>>;
std::string FillPage(std::string_view text, const PageValues& values);

class Page {
 public:
  // Stores the bytes, deflated; returns the index by which `data` refers to them.
  int AddBlob(std::span<const uint8_t> bytes);

  // `data` becomes REPORT of html/data.js.
  std::string Html(const std::string& title, const std::string& generator,
                   const nlohmann::ordered_json& data) const;

 private:
  std::vector<std::string> blobs_;  // base64
};

}  // namespace nacre
