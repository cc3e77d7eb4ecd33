// SPDX-License-Identifier: Apache-2.0
// cli/unknown_option.h: what is said of an option that a command does not have.
#pragma once

#include <optional>

#include <CLI/App.hpp>

#include "base/error.h"

namespace nacre {

// The first argument that the command has no use for, with the option that was likely meant, by its
// spelling or by the name that other programs have for it. Nothing if the parse failed of something
// else. A required option that is missing may be one that was misspelt.
std::optional<Error> UnknownArgument(const CLI::App& app, const CLI::ParseError& failure);

}  // namespace nacre
