// SPDX-License-Identifier: Apache-2.0
#include "report/child_process.h"

#include <array>
#include <cerrno>
#include <system_error>

#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"

extern char** environ;

namespace nacre {
namespace {

[[noreturn]] void Fail(const std::string& program, int error) {
  throw Error(ExitCode::kInternal, program, std::generic_category().message(error));
}

// An anonymous file in memory, not inherited unless it is named to the child.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& program) : program_(program) {
    descriptor_ = memfd_create("nacre", MFD_CLOEXEC);
    if (descriptor_ < 0) Fail(program_, errno);
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int descriptor() const { return descriptor_; }

  void Fill(std::string_view text) {
    for (off_t at = 0; !text.empty();) {
      const ssize_t written = pwrite(descriptor_, text.data(), text.size(), at);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) Fail(program_, written < 0 ? errno : ENOSPC);
      at += written;
      text.remove_prefix(static_cast<size_t>(written));
    }
  }

  std::string Content() const {
    std::string text;
    std::array<char, 65536> part;
    for (off_t at = 0;;) {
      const ssize_t got = pread(descriptor_, part.data(), part.size(), at);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) Fail(program_, errno);
      if (got == 0) return text;
      text.append(part.data(), static_cast<size_t>(got));
      at += got;
    }
  }

 private:
  const std::string& program_;
  int descriptor_ = -1;
};

// The exit code, or what a shell makes of a signal.
int WaitFor(const std::string& program, pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) Fail(program, errno);
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

ChildResult RunChild(const std::vector<std::string>& arguments, const std::string& input) {
  const std::string& program = arguments.front();
  MemoryFile in(program), out(program), errors(program);
  in.Fill(input);
  std::vector<std::string> copies = arguments;  // spawn wants them writable
  std::vector<char*> argv;
  argv.reserve(copies.size() + 1);
  for (std::string& copy : copies) argv.push_back(copy.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in.descriptor(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors.descriptor(), STDERR_FILENO);
  pid_t child = 0;
  const int error = posix_spawnp(&child, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);

  ChildResult result;
  if (error == ENOENT) {
    result.found = false;
    return result;
  }
  if (error != 0) Fail(program, error);
  result.status = WaitFor(program, child);
  result.output = out.Content();
  result.errors = errors.Content();
  return result;
}

}  // namespace nacre
