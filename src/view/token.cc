// SPDX-License-Identifier: Apache-2.0
#include "view/token.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"

namespace nacre {

std::string MakeToken() {
  std::array<uint8_t, 16> bytes;
  // The kernel gives so few at once, or none before it has begun to gather them.
  ssize_t got = -1;
  do {
    got = getrandom(bytes.data(), bytes.size(), 0);
  } while (got < 0 && errno == EINTR);
  if (got != static_cast<ssize_t>(bytes.size())) {
    throw Error(ExitCode::kInternal, "", "the kernel gives no random numbers");
  }
  std::string token;
  for (const uint8_t byte : bytes) {
    token += "0123456789abcdef"[byte >> 4];
    token += "0123456789abcdef"[byte & 15];
  }
  return token;
}

std::string KeptToken(unsigned port) {
  std::string token = MakeToken();
  const char* const folder = std::getenv("XDG_RUNTIME_DIR");
  if (folder == nullptr || folder[0] != '/') return token;
  const std::string path = std::string(folder) + "/nacre-view-" + std::to_string(port);
  const int file = open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (file < 0) return token;
  struct stat status = {};
  const bool own = fstat(file, &status) == 0 && S_ISREG(status.st_mode) &&
                   status.st_uid == geteuid() && (status.st_mode & (S_IRWXG | S_IRWXO)) == 0;
  std::array<char, 33> text;
  const ssize_t got = own ? pread(file, text.data(), text.size(), 0) : -1;
  const std::string_view kept(text.data(), got > 0 ? static_cast<size_t>(got) : 0);
  if (kept.size() == token.size() &&
      kept.find_first_not_of("0123456789abcdef") == std::string_view::npos) {
    token = kept;
  } else if (own && ftruncate(file, 0) == 0) {
    // If it cannot be kept, the next one is another.
    [[maybe_unused]] const ssize_t written = pwrite(file, token.data(), token.size(), 0);
  }
  close(file);
  return token;
}

bool SameToken(std::string_view token, std::string_view given) {
  if (token.empty()) return false;
  unsigned difference = token.size() == given.size() ? 0 : 1;
  for (size_t i = 0; i < given.size(); ++i) {
    difference |= static_cast<uint8_t>(given[i]) ^ static_cast<uint8_t>(token[i % token.size()]);
  }
  return difference == 0;
}

}  // namespace nacre
