// SPDX-License-Identifier: Apache-2.0
#include "cli/known_environment.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string_view>

namespace nacre {
namespace {

constexpr std::string_view kKnownVariables[] = {
    "PATH", "LD_LIBRARY_PATH", "HOME", "USER", "LOGNAME", "TMPDIR", "TERM", "COLUMNS", "LANG",
    "FONTCONFIG_FILE", "FONTCONFIG_PATH",
    // The desktop, for the browser:
    "DISPLAY", "WAYLAND_DISPLAY", "XAUTHORITY", "DBUS_SESSION_BUS_ADDRESS", "DESKTOP_SESSION",
    "KDE_FULL_SESSION", "KDE_SESSION_VERSION", "GNOME_DESKTOP_SESSION_ID", "BROWSER",
    "SSH_CONNECTION"};
constexpr std::string_view kKnownVariableBeginnings[] = {"LC_", "XDG_", "NACRE_"};

// For variables of the C library, some of whose values name files to read. Accepts only values that
// name the library's own files.
bool NamesNoFile(std::string_view name, std::string_view value) {
  if (name == "LANGUAGE") return value.find('/') == std::string_view::npos;
  // "Europe/Berlin" is a file of the time zone database, and so are values that begin like it;
  // TZDIR is not kept.
  return name == "TZ" && !value.starts_with('/') && !value.starts_with(":/") &&
         value.find("..") == std::string_view::npos;
}

bool IsKnown(std::string_view name, std::string_view value) {
  return NamesNoFile(name, value) ||
         std::ranges::find(kKnownVariables, name) != std::end(kKnownVariables) ||
         std::ranges::any_of(kKnownVariableBeginnings,
                             [&](std::string_view begin) { return name.starts_with(begin); });
}

}  // namespace

void KeepKnownEnvironment(char** environment) {
  char** kept = environment;
  for (char** entry = environment; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    const size_t end = std::min(text.find('='), text.size());
    if (IsKnown(text.substr(0, end), text.substr(std::min(end + 1, text.size())))) *kept++ = *entry;
  }
  *kept = nullptr;
}

}  // namespace nacre
