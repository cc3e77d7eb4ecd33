// SPDX-License-Identifier: Apache-2.0
// cli/print.h: prints text to standard output and standard error, as all output of the program, and
// writes text files.
//
// All printed text passes through base/printable.h. Arguments cannot even break a line: they may be
// names from files, whereas line breaks of the layout are in the format string.
#pragma once

#include <string>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>

#include "base/printable.h"

namespace nacre {

// Prints results, in whole lines. FinishOutput checks once whether they were written.
void PrintOut(std::string_view text);

// Prints everything else, to standard error. Failures are ignored, as they could not be reported.
void PrintError(std::string_view text);

// Converts an argument for printing: texts are made a single line, other types are unchanged.
template <class T>
decltype(auto) PrintedArgument(const T& value) {
  if constexpr (std::is_convertible_v<const T&, std::string_view>) {
    return Printable(value);
  } else {
    return (value);
  }
}
template <class T>
using PrintedAs = decltype(PrintedArgument(std::declval<const T&>()));

// PrintOut("{} of {} tiles\n", path, count): a format string of fmt with at least one argument.
template <class First, class... Rest>
void PrintOut(fmt::format_string<PrintedAs<First>, PrintedAs<Rest>...> format, const First& first,
              const Rest&... rest) {
  PrintOut(std::string_view(fmt::format(format, PrintedArgument(first), PrintedArgument(rest)...)));
}
template <class First, class... Rest>
void PrintError(fmt::format_string<PrintedAs<First>, PrintedAs<Rest>...> format, const First& first,
                const Rest&... rest) {
  PrintError(
      std::string_view(fmt::format(format, PrintedArgument(first), PrintedArgument(rest)...)));
}

// Throws Error (kCannotWrite) if not all of the printed text was written to standard output, or if
// that was closed when the program began.
void FinishOutput();

// Throws Error (kCannotWrite) if `path` cannot be written. "-" is standard output.
void CheckTextOutput(const std::string& path);
// Writes a text file, which appears completely or not at all.
void WriteText(const std::string& path, const std::string& text);

// Opens standard input, output and error on /dev/null if they are closed. Otherwise an output file
// could get their descriptor, and printed text with it.
void OpenStandardStreams();

}  // namespace nacre
