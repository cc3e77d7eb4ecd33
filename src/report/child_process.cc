// SPDX-License-Identifier: Apache-2.0
#include "report/child_process.h"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <system_error>

#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"

namespace nacre {
namespace {

[[noreturn]] void Fail(const std::string& program, int error) {
  throw Error(ExitCode::kInternal, program, std::generic_category().message(error));
}

// An anonymous file in memory. The child inherits it only if it is passed explicitly.
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

// The exit code, or 128 plus the number of the signal, as in a shell.
int WaitFor(const std::string& program, pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) Fail(program, errno);
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// The absolute folders in a list like PATH. Empty and relative entries depend on the working
// folder, which may be someone else's, and are dropped.
std::vector<std::string> AbsoluteFolders(std::string_view list) {
  std::vector<std::string> folders;
  while (true) {
    const std::string_view folder = list.substr(0, list.find(':'));
    if (folder.starts_with('/')) folders.emplace_back(folder);
    if (folder.size() == list.size()) return folders;
    list.remove_prefix(folder.size() + 1);
  }
}

std::string_view EnvironmentText(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr ? value : "";
}

// The environment of the child: where programs, libraries, fonts and their caches are, and the
// language. Other variables that gnuplot and its libraries read (GNUPLOT_LIB, GNUTERM,
// GIO_EXTRA_MODULES, ...) would change the diagram or name code to load.
std::vector<std::string> ChildEnvironment() {
  std::vector<std::string> environment;
  for (const char* name : {"LANG", "LC_ALL", "LC_CTYPE"}) {
    const std::string_view value = EnvironmentText(name);
    if (!value.empty()) environment.push_back(std::string(name) + "=" + std::string(value));
  }
  for (const char* name :
       {"PATH", "LD_LIBRARY_PATH", "HOME", "TMPDIR", "XDG_CACHE_HOME", "XDG_CONFIG_HOME",
        "XDG_DATA_HOME", "XDG_DATA_DIRS", "FONTCONFIG_FILE", "FONTCONFIG_PATH"}) {
    std::string absolute;
    for (const std::string& folder : AbsoluteFolders(EnvironmentText(name))) {
      absolute += (absolute.empty() ? "" : ":") + folder;
    }
    if (!absolute.empty()) environment.push_back(std::string(name) + "=" + absolute);
  }
  return environment;
}

// The argument format of posix_spawn: writable strings, ended by a null.
std::vector<char*> Pointers(std::vector<std::string>* texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts->size() + 1);
  for (std::string& text : *texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace

std::optional<std::string> FindProgram(const std::string& name) {
  for (const std::string& folder : AbsoluteFolders(EnvironmentText("PATH"))) {
    std::string file = folder + "/" + name;
    if (access(file.c_str(), X_OK) == 0) return file;
  }
  return std::nullopt;
}

ChildResult RunChild(const std::vector<std::string>& arguments, const std::string& input) {
  const std::string& program = arguments.front();
  ChildResult result;
  const std::optional<std::string> file = FindProgram(program);
  if (!file) {
    result.found = false;
    return result;
  }
  MemoryFile in(program), out(program), errors(program);
  in.Fill(input);
  std::vector<std::string> argument_copies = arguments;
  std::vector<std::string> environment = ChildEnvironment();

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in.descriptor(), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out.descriptor(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors.descriptor(), STDERR_FILENO);
  posix_spawn_file_actions_addchdir_np(&actions, "/");
  pid_t child = 0;
  const int error = posix_spawn(&child, file->c_str(), &actions, nullptr,
                                Pointers(&argument_copies).data(), Pointers(&environment).data());
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) Fail(program, error);
  result.status = WaitFor(program, child);
  result.output = out.Content();
  result.errors = errors.Content();
  return result;
}

}  // namespace nacre
