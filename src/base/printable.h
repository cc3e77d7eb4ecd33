// SPDX-License-Identifier: Apache-2.0
// base/printable.h: text out of files, names and paths, made safe to show.
//
// A stranger's file must not be able to clear the terminal, recolour it, type into it, or add lines
// that look like nacre's own. All messages (base/error.h), all that the program prints
// (cli/print.h) and all texts in diagrams, labels and reports pass through here.
#pragma once

#include <string>
#include <string_view>

namespace nacre {

// `text` with everything that acts instead of being shown spelled out: the control characters of
// ASCII and Latin-1 (C0, DEL, C1), those that reorder bidirectional text (U+202A to U+202E, U+2066
// to U+2069) and the line separators U+2028 and U+2029 become \n, \r, \t or \u001b; bytes that are
// not UTF-8 become \x9b. All other characters stay as they are, backslashes too.
std::string Printable(std::string_view text);

// The same for text of several lines: line feeds and tabs stay. JSON stays JSON of the same
// meaning: what is spelled out lies within its strings, and as JSON itself spells it.
std::string PrintableLines(std::string_view text);

}  // namespace nacre
