// SPDX-License-Identifier: Apache-2.0
#include "cli/print.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <span>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include "base/error.h"
#include "image_io/output_file.h"

namespace nacre {
namespace {

// Whether standard output was closed, and now is /dev/null, so that printed text is lost.
bool g_output_was_closed = false;
bool g_printed = false;

void PrintLines(std::string_view text, FILE* file) {
  const std::string printable = PrintableLines(text);
  std::fwrite(printable.data(), 1, printable.size(), file);
}

}  // namespace

void PrintOut(std::string_view text) {
  g_printed = g_printed || !text.empty();
  PrintLines(text, stdout);
}

void PrintError(std::string_view text) { PrintLines(text, stderr); }

void FinishOutput() {
  if (g_output_was_closed && g_printed) {
    throw Error(ExitCode::kCannotWrite, "standard output", "is closed",
                "what was printed went nowhere");
  }
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw Error(ExitCode::kCannotWrite, "standard output",
              errno != 0 ? std::strerror(errno) : "not all of it could be written",
              "what was printed is not complete");
}

void CheckTextOutput(const std::string& path) {
  if (path != "-") CheckWritable(path);
}

void WriteText(const std::string& path, const std::string& text) {
  if (path == "-") return PrintOut(text);
  OutputFile file(path);
  file.Write(0, std::span(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
  file.Commit();
}

void OpenStandardStreams() {
  g_output_was_closed = fcntl(STDOUT_FILENO, F_GETFD) < 0 && errno == EBADF;
  int descriptor = open("/dev/null", O_RDWR);
  while (descriptor >= 0 && descriptor <= STDERR_FILENO) descriptor = open("/dev/null", O_RDWR);
  if (descriptor > STDERR_FILENO) close(descriptor);
}

}  // namespace nacre
