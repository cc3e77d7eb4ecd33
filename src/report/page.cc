// SPDX-License-Identifier: Apache-2.0
#include "report/page.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/printable.h"
#include "image_io/deflate.h"
#include "report/page_parts.h"

namespace nacre {
namespace {

constexpr int kDeflateLevel = 6;  // zlib's default, since files are written once, but mailed and
                                  // kept

// Escapes JSON for a <script>, where "</script" and "<!--" would end it or change its parsing.
std::string EscapeJson(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (const char& c : json) out += c == '<' ? "\\u003c" : std::string_view(&c, 1);
  return out;
}

// The tree with PrintableLines() applied to all of its texts, including names of members.
nlohmann::ordered_json PrintableTree(const nlohmann::ordered_json& tree) {
  if (tree.is_string()) return PrintableLines(tree.get_ref<const std::string&>());
  if (!tree.is_structured()) return tree;
  nlohmann::ordered_json printable =
      tree.is_array() ? nlohmann::ordered_json::array() : nlohmann::ordered_json::object();
  for (const auto& [name, value] : tree.items()) {
    if (tree.is_array()) {
      printable.push_back(PrintableTree(value));
    } else {
      printable[PrintableLines(name)] = PrintableTree(value);
    }
  }
  return printable;
}

}  // namespace

std::string Base64(std::span<const uint8_t> bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t count = std::min<size_t>(3, bytes.size() - i);
    uint32_t group = 0;
    for (size_t b = 0; b < 3; ++b) group = group << 8 | (b < count ? bytes[i + b] : 0u);
    for (size_t d = 0; d < 4; ++d) {
      out += d <= count ? kDigits[group >> (18 - 6 * d) & 63] : '=';
    }
  }
  return out;
}

std::string EscapeHtml(std::string_view text) {
  std::string out;
  for (const char& c : text) {
    out += c == '&'   ? "&amp;"
           : c == '<' ? "&lt;"
           : c == '>' ? "&gt;"
           : c == '"' ? "&quot;"
                      : std::string_view(&c, 1);
  }
  return out;
}

std::string PolicySource(std::string_view sha256) {
  std::vector<uint8_t> bytes;
  bytes.reserve(sha256.size() / 2);
  for (size_t i = 0; i + 1 < sha256.size(); i += 2) {
    bytes.push_back(static_cast<uint8_t>(std::stoi(std::string(sha256.substr(i, 2)), nullptr, 16)));
  }
  return "sha256-" + Base64(bytes);
}

std::string ScriptJson(const nlohmann::ordered_json& data) {
  return EscapeJson(
      PrintableTree(data).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

std::string FillPage(std::string_view text, const PageValues& values) {
  std::string out;
  while (true) {
    const size_t open = text.find("{{");
    out += text.substr(0, open);
    if (open == std::string_view::npos) return out;
    const size_t close = text.find("}}", open);
    const std::string_view name = text.substr(open + 2, close - open - 2);
    for (const auto& [key, value] : values) {
      if (key == name) out += value;
    }
    text.remove_prefix(close + 2);
  }
}

int Page::AddBlob(std::span<const uint8_t> bytes) {
  blobs_.push_back(Base64(Deflate(bytes, DeflateForm::kZlib, kDeflateLevel)));
  return static_cast<int>(blobs_.size()) - 1;
}

std::string Page::Html(const std::string& title, const std::string& generator,
                       const nlohmann::ordered_json& data) const {
  std::string blobs;
  for (size_t i = 0; i < blobs_.size(); ++i) {
    blobs += fmt::format("<script type=\"application/octet-stream\" id=\"blob{}\">", i);
    blobs += blobs_[i];
    blobs += "</script>\n";
  }
  const std::string json = ScriptJson(data);
  const std::string script_hash = PolicySource(PageScriptSha256());
  const std::string style_hash = PolicySource(PageStyleSha256());
  const std::string safe_title = EscapeHtml(Printable(title));
  const std::string safe_generator = EscapeHtml(generator);
  return FillPage(PageTemplate(), {{"title", safe_title},
                                   {"generator", safe_generator},
                                   {"style_hash", style_hash},
                                   {"script_hash", script_hash},
                                   {"style", PageStyle()},
                                   {"script", PageScript()},
                                   {"data", json},
                                   {"blobs", blobs}});
}

}  // namespace nacre
