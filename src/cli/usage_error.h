// SPDX-License-Identifier: Apache-2.0
// cli/usage_error.h: what is said of a command line that CLI11 refuses.
#pragma once

#include <CLI/App.hpp>

#include "base/error.h"

namespace nacre {

// In nacre's own words. Of an argument that the command has no use for, the first is named, with
// the option that was likely meant, by its spelling or by the name that other programs have for it.
// A required option that is missing may be one that was misspelt.
Error UsageError(const CLI::App& app, const CLI::ParseError& failure);

}  // namespace nacre
