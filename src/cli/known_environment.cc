// SPDX-License-Identifier: Apache-2.0
#include "cli/known_environment.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include <unistd.h>

namespace nacre {
namespace {

constexpr std::string_view kKnownVariables[] = {
    "PATH", "LD_LIBRARY_PATH", "HOME", "USER", "LOGNAME", "TMPDIR", "TERM", "COLUMNS", "LANG",
    "FONTCONFIG_FILE", "FONTCONFIG_PATH",
    // Of the desktop, for the browser.
    "DISPLAY", "WAYLAND_DISPLAY", "XAUTHORITY", "DBUS_SESSION_BUS_ADDRESS", "DESKTOP_SESSION",
    "KDE_FULL_SESSION", "KDE_SESSION_VERSION", "GNOME_DESKTOP_SESSION_ID", "BROWSER",
    "SSH_CONNECTION"};
constexpr std::string_view kKnownVariableBeginnings[] = {"LC_", "XDG_", "NACRE_"};

bool IsKnown(std::string_view name) {
  return std::ranges::find(kKnownVariables, name) != std::end(kKnownVariables) ||
         std::ranges::any_of(kKnownVariableBeginnings,
                             [&](std::string_view begin) { return name.starts_with(begin); });
}

}  // namespace

void KeepKnownEnvironment() {
  std::vector<std::string> others;
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    const std::string_view name = text.substr(0, text.find('='));
    if (!IsKnown(name)) others.emplace_back(name);
  }
  for (const std::string& name : others) unsetenv(name.c_str());
}

}  // namespace nacre
