// SPDX-License-Identifier: Apache-2.0
// base/printable.h: makes text from files, names and paths safe to print.
//
// An untrusted file must not be able to clear the terminal, recolour it, type into it, or add lines
// that look like nacre's own. All messages (base/error.h), all output of the program (cli/print.h)
// and all texts in diagrams, labels and reports pass through here.
#pragma once

#include <string>
#include <string_view>

namespace nacre {

// `text` with all control characters escaped: those of ASCII and Latin-1 (C0, DEL, C1), those that
// reorder bidirectional text (U+202A to U+202E, U+2066 to U+2069) and the line separators U+2028
// and U+2029 become \n, \r, \t or \u001b; bytes that are not UTF-8 become \x9b. All other
// characters, backslashes included, stay as they are.
std::string Printable(std::string_view text);

// Printable for text of several lines: keeps line feeds and tabs. JSON keeps its meaning, because
// the escaped characters occur only in its strings, and are escaped as in JSON.
std::string PrintableLines(std::string_view text);

}  // namespace nacre
