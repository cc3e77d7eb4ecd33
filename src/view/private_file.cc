// SPDX-License-Identifier: Apache-2.0
#include "view/private_file.h"

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace nacre {
namespace {

bool IsOursAlone(const struct stat& status) {
  return status.st_uid == geteuid() && (status.st_mode & (S_IRWXG | S_IRWXO)) == 0;
}

bool IsPrivateFolder(const std::string& path) {
  struct stat status = {};
  return lstat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && IsOursAlone(status);
}

// The value of a variable if it is an absolute path, as the XDG specification requires.
std::string FolderOf(const char* variable) {
  const char* const value = std::getenv(variable);
  return value != nullptr && value[0] == '/' ? value : "";
}

}  // namespace

std::string SessionFolder() {
  std::string folder = FolderOf("XDG_RUNTIME_DIR");
  return IsPrivateFolder(folder) ? folder : "";
}

std::string StateFolder() {
  std::string folder = FolderOf("XDG_STATE_HOME");
  if (folder.empty()) {
    folder = FolderOf("HOME");
    if (folder.empty()) return "";
    folder += "/.local/state";
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  folder += "/nacre";
  if (mkdir(folder.c_str(), S_IRWXU) != 0 && errno != EEXIST) return "";
  return IsPrivateFolder(folder) ? folder : "";
}

std::optional<std::string> ReadPrivateFile(const std::string& path, size_t max_bytes) {
  const int file = open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return std::nullopt;
  struct stat status = {};
  std::optional<std::string> text;
  if (fstat(file, &status) == 0 && S_ISREG(status.st_mode) && IsOursAlone(status) &&
      static_cast<uintmax_t>(status.st_size) <= max_bytes) {
    text.emplace(static_cast<size_t>(status.st_size), '\0');
    size_t done = 0;
    ssize_t got = 1;
    while (done < text->size() && got > 0) {
      got = read(file, text->data() + done, text->size() - done);
      if (got > 0) done += static_cast<size_t>(got);
    }
    if (done < text->size()) text.reset();
  }
  close(file);
  return text;
}

bool WritePrivateFile(const std::string& path, std::string_view text) {
  const std::string beside = path + ".new";
  unlink(beside.c_str());  // left by a writer that was killed
  const int file =
      open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (file < 0) return false;
  bool whole = true;
  while (whole && !text.empty()) {
    const ssize_t written = write(file, text.data(), text.size());
    if (written > 0) text.remove_prefix(static_cast<size_t>(written));
    whole = written > 0 || (written < 0 && errno == EINTR);
  }
  whole = close(file) == 0 && whole;
  if (whole && std::rename(beside.c_str(), path.c_str()) == 0) return true;
  unlink(beside.c_str());
  return false;
}

}  // namespace nacre
