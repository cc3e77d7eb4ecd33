// SPDX-License-Identifier: Apache-2.0
// cli/print.h: text to standard output and standard error.
#pragma once

#include <string_view>

namespace nacre {

// Results. Whether they arrived is checked once, by FinishOutput.
void PrintOut(std::string_view text);

// Everything else. Standard error may be full or closed: then there is nobody to tell.
void PrintError(std::string_view text);

// Throws Error (kCannotWrite) if standard output did not take all of what was printed.
void FinishOutput();

// Opens standard input, output and error on /dev/null where they are closed, so that no file of
// ours gets their numbers and then what is printed.
void OpenStandardStreams();

}  // namespace nacre
