// SPDX-License-Identifier: Apache-2.0
// cli/usage_error.h: the error messages for command lines that CLI11 refuses.
#pragma once

#include <CLI/App.hpp>

#include "base/error.h"

namespace nacre {

// Words the error as nacre does. The first argument that the command cannot use is named, with the
// option that was likely meant, judged by its spelling or by the name in other programs. A required
// option that is missing may have been misspelt.
Error UsageError(const CLI::App& app, const CLI::ParseError& failure);

}  // namespace nacre
