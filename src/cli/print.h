// SPDX-License-Identifier: Apache-2.0
// cli/print.h: text to standard output and standard error: all that the program says.
//
// Whatever is printed passes through base/printable.h. The text of a single argument cannot even
// break the line: names out of files are given as arguments, layout stands in the format.
#pragma once

#include <string>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>

#include "base/printable.h"

namespace nacre {

// Results: whole lines. Whether they arrived is checked once, by FinishOutput.
void PrintOut(std::string_view text);

// Everything else, to standard error. Failures to write there are ignored: there is nowhere left
// to report them.
void PrintError(std::string_view text);

// An argument as it is printed: texts on one line, everything else as it is.
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

// PrintOut("{} of {} tiles\n", path, count): fmt's format, with at least one argument.
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

// Throws Error (kCannotWrite) if standard output did not take all of what was printed, or was
// closed when the program began.
void FinishOutput();

// Opens standard input, output and error on /dev/null where they are closed, so that no file of
// ours gets their numbers and then what is printed.
void OpenStandardStreams();

}  // namespace nacre
