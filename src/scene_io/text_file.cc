// SPDX-License-Identifier: Apache-2.0
#include "scene_io/text_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "base/error.h"
#include "base/excerpt.h"

namespace nacre {
namespace {

constexpr double kGibibyte = 1024.0 * 1024 * 1024;

bool IsBelow(const std::filesystem::path& path, const std::filesystem::path& folder) {
  const auto [folder_end, path_end] =
      std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return folder_end == folder.end() && path_end != path.end();
}

}  // namespace

std::string ReadTextFile(const std::filesystem::path& path, uint64_t max_bytes) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw Error(ExitCode::kBadInput, path.string(), "is a folder", "name a file");
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw Error(ExitCode::kBadInput, path.string(),
                std::string("cannot be opened: ") + std::strerror(errno));
  }
  // In pieces, because a pipe does not tell its size: each as long as all before it, so that a
  // short file is not paid for as a long one.
  std::string text;
  constexpr size_t kFirstPiece = 1 << 16;
  while (file) {
    const size_t before = text.size(), piece = std::max(before, kFirstPiece);
    text.resize(before + piece);
    file.read(text.data() + before, static_cast<std::streamsize>(piece));
    text.resize(before + static_cast<size_t>(file.gcount()));
    if (text.size() > max_bytes) {
      throw Error(
          ExitCode::kBadInput, path.string(),
          fmt::format("is longer than {:g} GiB", static_cast<double>(max_bytes) / kGibibyte),
          "is it the right file?");
    }
  }
  if (file.bad()) {
    throw Error(ExitCode::kBadInput, path.string(),
                std::string("cannot be read: ") + std::strerror(errno));
  }
  return text;
}

std::filesystem::path ResolveReference(const std::filesystem::path& folder, const std::string& name,
                                       const ReferenceRules& rules) {
  // The system's calls would end the name there, and look at another file than is judged here.
  if (name.find('\0') != std::string::npos) {
    throw Error(ExitCode::kBadInput, {}, "a file's name has a character 0 in it");
  }
  std::error_code error;
  const std::filesystem::path base = std::filesystem::weakly_canonical(
      folder.empty() ? std::filesystem::path(".") : folder, error);
  std::filesystem::path path =
      error ? std::filesystem::path() : std::filesystem::weakly_canonical(base / name, error);
  if (error || name.empty()) {
    throw Error(ExitCode::kBadInput, {}, fmt::format("\"{}\" is not a path", Excerpt(name)));
  }
  // Before looking whether it exists, which is nobody's business outside the folder.
  const bool is_trusted =
      std::find(rules.trusted.begin(), rules.trusted.end(), path) != rules.trusted.end();
  if (!rules.allow_paths && !is_trusted && !IsBelow(path, base)) {
    throw Error(ExitCode::kBadInput, {},
                fmt::format("\"{}\" is outside the scene's folder", Excerpt(name)),
                "move it there, or allow it with --allow-paths");
  }
  if (!std::filesystem::exists(path, error)) {
    throw Error(ExitCode::kBadInput, {}, fmt::format("there is no file \"{}\"", Excerpt(name)),
                fmt::format("it was looked for as {}", path.string()));
  }
  if (!std::filesystem::is_regular_file(path, error)) {
    throw Error(ExitCode::kBadInput, {},
                fmt::format("\"{}\" is not a regular file", Excerpt(name)));
  }
  if (rules.on_file) rules.on_file(path);
  return path;
}

}  // namespace nacre
