// SPDX-License-Identifier: Apache-2.0
#include "cli/given_options.h"

#include <fmt/format.h>

#include "base/error.h"

namespace nacre {

void RefuseOptions(const CLI::App& command, const std::function<bool(const CLI::Option&)>& applies,
                   const std::string& what, const std::string& hint) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0 || applies(*option)) continue;
    throw Error(ExitCode::kUsage, option->get_name(), "cannot be used with " + what, hint);
  }
}

}  // namespace nacre
