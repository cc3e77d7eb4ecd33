// SPDX-License-Identifier: Apache-2.0
#include "view/token.h"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/random.h>

#include "base/error.h"
#include "view/private_file.h"

namespace nacre {
namespace {

constexpr size_t kTokenBytes = 16;

}  // namespace

std::string MakeToken() {
  std::array<uint8_t, kTokenBytes> bytes;
  // So few bytes come in one call, or none before the kernel's generator is seeded.
  ssize_t got = -1;
  do {
    got = getrandom(bytes.data(), bytes.size(), 0);
  } while (got < 0 && errno == EINTR);
  if (got != static_cast<ssize_t>(bytes.size())) {
    throw Error(ExitCode::kInternal, "", "the kernel gives no random numbers");
  }
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

std::string KeptToken(unsigned port) {
  const std::string folder = SessionFolder();
  if (folder.empty()) return MakeToken();
  const std::string path = folder + "/nacre-view-" + std::to_string(port);
  const std::optional<std::string> kept = ReadPrivateFile(path, 2 * kTokenBytes);
  if (kept && kept->size() == 2 * kTokenBytes &&
      kept->find_first_not_of("0123456789abcdef") == std::string::npos) {
    return *kept;
  }
  std::string token = MakeToken();
  WritePrivateFile(path, token);  // if that fails, the next server has another token
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
