// SPDX-License-Identifier: Apache-2.0
#include "scene_io/text_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/excerpt.h"
#include "base/input_file.h"
#include "scene_io/text_lines.h"

namespace nacre {
namespace {

constexpr double kMebibyte = 1024.0 * 1024, kGibibyte = 1024 * kMebibyte;

constexpr size_t kLeastPiece = size_t{1} << 12, kFirstPiece = size_t{1} << 16,
                 kPiece = size_t{1} << 20;

std::string SizeText(uint64_t bytes) {
  const auto size = static_cast<double>(bytes);
  return size < kGibibyte ? fmt::format("{:g} MiB", size / kMebibyte)
                          : fmt::format("{:g} GiB", size / kGibibyte);
}

struct Descriptor {
  int number = -1;
  Descriptor() = default;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number >= 0) close(number);
  }
};

// An open regular file. Devices and pipes are refused before they are opened, because opening them
// might block forever.
class InputFile {
 public:
  explicit InputFile(const std::filesystem::path& path) : path_(path.string()) {
    struct stat status = {};
    // The second check is of the opened file, since the name may by then refer to another one.
    if (stat(path_.c_str(), &status) != 0) Refuse("cannot be opened");
    CheckKind(status);
    descriptor_.number = open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor_.number < 0) Refuse("cannot be opened");
    if (fstat(descriptor_.number, &status) != 0) Refuse("cannot be read");
    CheckKind(status);
    size_ = static_cast<uint64_t>(status.st_size);
    std::array<char, kLfsPointerHead> head{};
    const ssize_t got = pread(descriptor_.number, head.data(), size_ > 0 ? head.size() : 0, 0);
    RefuseLfsPointer(path_, {head.data(), static_cast<size_t>(std::max<ssize_t>(got, 0))});
  }
  uint64_t size() const { return size_; }

  // Appends up to `count` bytes; returns how many, 0 at the end of the file.
  size_t Append(size_t count, std::string* bytes) const {
    const size_t before = bytes->size();
    bytes->resize(before + count);
    ssize_t got = 0;
    do {
      got = read(descriptor_.number, bytes->data() + before, count);
    } while (got < 0 && errno == EINTR);
    if (got < 0) Refuse("cannot be read");
    bytes->resize(before + static_cast<size_t>(got));
    return static_cast<size_t>(got);
  }

  [[noreturn]] void RefuseLength(uint64_t max_bytes) const {
    throw Error(ExitCode::kBadInput, path_, "is longer than " + SizeText(max_bytes),
                "is it the right file?");
  }

 private:
  [[noreturn]] void Refuse(const char* what) const {
    throw Error(ExitCode::kBadInput, path_, fmt::format("{}: {}", what, std::strerror(errno)));
  }

  void CheckKind(const struct stat& status) const {
    if (S_ISDIR(status.st_mode)) {
      throw Error(ExitCode::kBadInput, path_, "is a folder", "name a file");
    }
    if (!S_ISREG(status.st_mode)) {
      throw Error(ExitCode::kBadInput, path_, "is not a regular file",
                  "devices and pipes are not read");
    }
  }

  std::string path_;
  Descriptor descriptor_;
  uint64_t size_ = 0;
};

bool IsBelow(const std::filesystem::path& path, const std::filesystem::path& folder) {
  const auto [folder_end, path_end] =
      std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return folder_end == folder.end() && path_end != path.end();
}

}  // namespace

std::string ReadBytes(const std::filesystem::path& path, uint64_t max_bytes,
                      const std::function<uint64_t(std::string_view, uint64_t)>& judge) {
  const InputFile file(path);
  std::string bytes;
  file.Append(kFirstPiece, &bytes);
  const uint64_t length = std::max<uint64_t>(file.size(), bytes.size());
  const uint64_t wanted = judge ? std::min(judge(bytes, length), length) : length;
  if (wanted > max_bytes) file.RefuseLength(max_bytes);
  bytes.reserve(wanted);
  while (bytes.size() < wanted) {
    if (file.Append(std::min(kPiece, wanted - bytes.size()), &bytes) == 0) break;
  }
  bytes.resize(std::min<uint64_t>(bytes.size(), wanted));
  return bytes;
}

std::string ReadTextFile(const std::filesystem::path& path, uint64_t max_bytes) {
  const InputFile file(path);
  if (file.size() > max_bytes) file.RefuseLength(max_bytes);
  std::string text;
  while (true) {  // up to the end, as kernel files (/proc) claim to have size 0
    const size_t before = text.size();
    const uint64_t left = file.size() - std::min<uint64_t>(file.size(), before);
    const size_t most = before == 0 ? kFirstPiece : kPiece;
    if (file.Append(std::clamp<uint64_t>(left, kLeastPiece, most), &text) == 0) return text;
    if (before == 0) WithoutByteOrderMark(text, path.string());  // refuses UTF-16
    const size_t zero = text.find('\0', before);
    if (zero != std::string::npos) RefuseZero(text, zero, path.string());
    if (text.size() > max_bytes) file.RefuseLength(max_bytes);
    // Reserves memory only once it looks like text: the file may be huge.
    if (before == 0) text.reserve(std::max<uint64_t>(file.size(), text.size()) + kLeastPiece);
  }
}

void RefuseZero(std::string_view text, size_t zero, const std::string& file) {
  const auto line = std::count(text.begin(), text.begin() + static_cast<ptrdiff_t>(zero), '\n') + 1;
  throw Error(ExitCode::kBadInput, fmt::format("{}:{}", file, line),
              "is not text: there is a character 0", "is it the right file?");
}

std::filesystem::path ResolveReference(const std::filesystem::path& folder, const std::string& name,
                                       const ReferenceRules& rules) {
  // System calls would end the name there, and open another file than the one that is checked here.
  if (name.find('\0') != std::string::npos) {
    throw Error(ExitCode::kBadInput, {}, "a file's name has a character 0 in it");
  }
  std::error_code error;
  const std::filesystem::path base = std::filesystem::weakly_canonical(
      folder.empty() ? std::filesystem::path(".") : folder, error);
  // Reports the file by its name, before links are followed, because their target may change, even
  // at this moment. A link in the folder that leads out of it may be mended.
  const std::filesystem::path named = folder / name;
  const bool in_folder = IsBelow((base / name).lexically_normal(), base);
  if (rules.on_file && !error && (rules.allow_paths || in_folder)) rules.on_file(named);
  std::filesystem::path path =
      error ? std::filesystem::path() : std::filesystem::weakly_canonical(base / name, error);
  if (error || name.empty()) {
    throw Error(ExitCode::kBadInput, {}, fmt::format("\"{}\" is not a path", Excerpt(name)));
  }
  // This is checked before the file's existence, which is nobody's business outside the folder.
  const bool is_trusted =
      std::find(rules.trusted.begin(), rules.trusted.end(), path) != rules.trusted.end();
  if (!rules.allow_paths && !is_trusted && !IsBelow(path, base)) {
    throw Error(ExitCode::kBadInput, {}, fmt::format("\"{}\"{}", Excerpt(name), kIsOutside),
                "move it there, or allow it with --allow-paths");
  }
  if (rules.on_file && !rules.allow_paths && !in_folder) rules.on_file(named);
  // To the system, "missing/../a.png" does not exist.
  if (rules.on_file && !std::filesystem::exists(named, error)) rules.on_file(path);
  if (!std::filesystem::exists(path, error)) {
    throw Error(ExitCode::kBadInput, {}, fmt::format("there is no file \"{}\"", Excerpt(name)),
                fmt::format("it was looked for as {}", path.string()));
  }
  if (!std::filesystem::is_regular_file(path, error)) {
    throw Error(ExitCode::kBadInput, {},
                fmt::format("\"{}\" is not a regular file", Excerpt(name)));
  }
  return path;
}

}  // namespace nacre
