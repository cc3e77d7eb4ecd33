// SPDX-License-Identifier: Apache-2.0
// tests/image_io/output_file_test.cc: files appear whole or not at all.
#include "image_io/output_file.h"

#include <array>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstddef>

#include <fcntl.h>
#include <grp.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/inotify.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <sys/xattr.h>
#include <unistd.h>

#include "files.h"

namespace nacre {
namespace {

namespace fs = std::filesystem;

const std::vector<uint8_t> kOld = {'o', 'l', 'd'};
const std::vector<uint8_t> kNew = {'n', 'e', 'w', '!'};

void WriteFile(const std::string& path, bool sync = false) {
  OutputFile file(path);
  file.Write(0, kNew);
  file.Commit(sync);
}

// A child process runs `body`; its status as waitpid gives it.
template <class Body>
int InChild(const Body& body) {
  const pid_t child = fork();
  if (child == 0) {
    bool good = false;
    try {
      good = body();
    } catch (...) {
    }
    _exit(good ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  return status;
}

bool HasAnonymousFiles(const std::string& folder) {
  const int descriptor = open(folder.c_str(), O_TMPFILE | O_WRONLY, 0600);
  if (descriptor >= 0) close(descriptor);
  return descriptor >= 0;
}

// From here on this process cannot open anonymous files, as on a file system without them.
bool ForbidAnonymousFiles() {
  constexpr uint32_t kFlagsOffset = offsetof(seccomp_data, args) + 2 * sizeof(uint64_t);
  constexpr uint32_t kAnonymous = O_TMPFILE & ~O_DIRECTORY;
  std::array<sock_filter, 6> program = {
      sock_filter BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_openat, 0, 3),
      sock_filter BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kFlagsOffset),
      sock_filter BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, kAnonymous, 0, 1),
      sock_filter BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EOPNOTSUPP),
      sock_filter BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)};
  const sock_fprog filter = {static_cast<uint16_t>(program.size()), program.data()};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0;
}

// While alive, no file can grow past `bytes`: a disk that is full.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &saved_);
    const rlimit limit = {bytes, saved_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &saved_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit saved_{};
  void (*handler_)(int);
};

TEST_CASE("a file appears when it is committed") {
  const TestFolder folder;
  const std::string path = folder / "a.png";
  {
    OutputFile file(path);
    CHECK_FALSE(fs::exists(path));
    file.Write(2, std::span(kNew).subspan(2));  // in any order
    file.Write(0, std::span(kNew).first(2));
    CHECK_FALSE(fs::exists(path));
    file.Commit();
  }
  CHECK(ReadBytes(path) == kNew);
  CHECK(folder.file_count() == 1);
  WriteFile(folder / "synced.png", true);
  CHECK(ReadBytes(folder / "synced.png") == kNew);
}

TEST_CASE("without a commit nothing remains and the old file stays") {
  const TestFolder folder;
  const std::string path = folder / "a.png";
  { OutputFile(path).Write(0, kNew); }
  CHECK(folder.file_count() == 0);
  WriteBytes(path, kOld);
  { OutputFile(path).Write(0, kNew); }
  CHECK(ReadBytes(path) == kOld);
  CHECK(folder.file_count() == 1);
  WriteFile(path);
  CHECK(ReadBytes(path) == kNew);
  CHECK(folder.file_count() == 1);
}

TEST_CASE("a file is replaced without being gone in between") {
  const TestFolder folder;
  const std::string path = folder / "image.exr";
  WriteFile(path);
  // The system reports what loses its name in the folder.
  const int watch = inotify_init1(IN_NONBLOCK);
  REQUIRE(inotify_add_watch(watch, folder.path().c_str(), IN_DELETE) >= 0);
  for (const bool sync : {false, true}) WriteFile(path, sync);
  std::array<char, sizeof(inotify_event) + NAME_MAX + 1> event;
  CHECK(read(watch, event.data(), event.size()) == -1);
  CHECK(errno == EAGAIN);  // nothing was deleted
  close(watch);
}

TEST_CASE("a killed process leaves nothing") {
  const TestFolder folder;
  if (!HasAnonymousFiles(folder.path())) return;  // then the hidden file stays
  const int status = InChild([&] {
    OutputFile file(folder / "a.png");
    file.Write(0, kNew);
    raise(SIGKILL);
    return true;
  });
  CHECK(WIFSIGNALED(status));
  CHECK(folder.file_count() == 0);
}

TEST_CASE("a file system without anonymous files") {
  const TestFolder folder;
  const std::string path = folder / "a.png";
  const int status = InChild([&] {
    if (!ForbidAnonymousFiles() || HasAnonymousFiles(folder.path())) return false;
    { OutputFile(path).Write(0, kOld); }
    if (folder.file_count() != 0) return false;
    WriteBytes(path, kOld);
    OutputFile file(path);
    file.Write(0, kNew);
    if (folder.file_count() != 2 || ReadBytes(path) != kOld) return false;
    file.Commit();
    return ReadBytes(path) == kNew && folder.file_count() == 1;
  });
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
}

TEST_CASE("a replaced file's mode, owner and attributes stay") {
  for (const bool anonymous : {true, false}) {
    CHECK(InChild([&] {  // a child, because what it gives up does not come back
            const TestFolder folder;
            const std::string path = folder / "a.png";
            WriteBytes(path, kOld);
            if (!anonymous && !ForbidAnonymousFiles()) return true;
            const bool has_attributes = setxattr(path.c_str(), "user.nacre", "kept", 4, 0) == 0;
            const bool is_root = geteuid() == 0 && chown(path.c_str(), 1234, 5678) == 0;
            for (const mode_t mode : {0600u, 0640u, 0664u, 0777u}) {
              if (chmod(path.c_str(), mode) != 0) return false;
              WriteFile(path);
              struct stat status {};
              if (stat(path.c_str(), &status) != 0 || (status.st_mode & 07777) != mode)
                return false;
              if (is_root && (status.st_uid != 1234 || status.st_gid != 5678)) return false;
              char value[4] = {};
              if (has_attributes && getxattr(path.c_str(), "user.nacre", value, 4) != 4)
                return false;
              if (ReadBytes(path) != kNew) return false;
            }
            return true;
          }) == 0);
  }
}

TEST_CASE("what a group may not see, no other group may because of a replacement") {
  if (geteuid() != 0) return;  // who cannot give files away has no such file
  const TestFolder folder;
  const std::string path = folder / "a.png";
  WriteBytes(path, kOld);
  REQUIRE(chmod(path.c_str(), 0660) == 0);
  REQUIRE(chown(path.c_str(), 1234, 5678) == 0);
  REQUIRE(chmod(folder.path().c_str(), 0777) == 0);
  CHECK(InChild([&] {
          if (setgroups(0, nullptr) != 0 || setgid(4321) != 0 || setuid(1234) != 0) return false;
          WriteFile(path);
          struct stat status {};
          return stat(path.c_str(), &status) == 0 && status.st_gid == 4321 &&
                 (status.st_mode & 0777) == 0600;
        }) == 0);
}

TEST_CASE("a file has one identity, however it is called, and others have others") {
  const TestFolder folder;
  const fs::path here = fs::current_path();
  fs::current_path(folder.path());
  fs::create_directory("sub");
  fs::create_symlink("sub", "link");
  fs::create_symlink("new.png", "to_new.png");
  fs::create_symlink("to_new.png", "to_that.png");
  const std::vector<std::string> names = {
      "new.png",          "./new.png",  ".//new.png",         "sub/../new.png", "link/../new.png",
      folder / "new.png", "to_new.png", "sub/../to_that.png", "./to_that.png"};
  for (const bool is_there : {false, true}) {
    if (is_there) WriteBytes("new.png", kOld);
    for (const std::string& name : names) CHECK(FileIdentity(name) == FileIdentity("new.png"));
    for (const char* other : {"new.pn", "New.png", "sub/new.png", "link/new.png", "sub", "."}) {
      CHECK(FileIdentity(other) != FileIdentity("new.png"));
    }
    CHECK(FileIdentity("sub/a") == FileIdentity("link/a"));
  }
  fs::create_hard_link("new.png", "hard.png");
  CHECK(FileIdentity("hard.png") == FileIdentity("new.png"));
  CHECK(FileIdentity("no/folder.png") != FileIdentity("no/other.png"));
  fs::current_path(here);
}

TEST_CASE("files get the permissions of new files") {
  const TestFolder folder;
  const mode_t saved = umask(027);
  WriteFile(folder / "a.png");
  umask(saved);
  struct stat status;
  REQUIRE(stat((folder / "a.png").c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == 0640);
}

TEST_CASE("symbolic links are followed") {
  const TestFolder folder;
  fs::create_directory(folder / "inner");
  WriteBytes(folder / "inner/real.png", kOld);
  fs::create_symlink("inner/real.png", folder / "link.png");
  fs::create_symlink("inner/absent.png", folder / "dangling.png");
  fs::create_symlink("loop.png", folder / "loop.png");
  WriteFile(folder / "link.png");
  CHECK(fs::is_symlink(folder / "link.png"));
  CHECK(ReadBytes(folder / "inner/real.png") == kNew);
  WriteFile(folder / "dangling.png");
  CHECK(fs::is_symlink(folder / "dangling.png"));
  CHECK(ReadBytes(folder / "inner/absent.png") == kNew);
  CHECK(Catching([&] { CheckWritable(folder / "loop.png"); }).code == ExitCode::kCannotWrite);
}

TEST_CASE("what cannot be written is refused at once, and stays what it is") {
  const TestFolder folder;
  fs::create_directory(folder / "inner");
  WriteBytes(folder / "file", kOld);
  REQUIRE(mkfifo((folder / "fifo").c_str(), 0600) == 0);
  fs::create_symlink("/dev/null", folder / "to_device");
  const std::string long_name(300, 'x');
  struct Row {
    std::string path, what;
  };
  const std::vector<Row> rows = {{folder / "absent/a.png", "absent does not exist"},
                                 {folder / "file/a.png", "file is not a folder"},
                                 {folder / "inner", "is a folder"},
                                 {folder / "inner/", "is a folder"},
                                 {folder / "new/", "new does not exist"},
                                 {folder / "fifo", "not a regular file"},
                                 {folder / "to_device", "not a regular file"},
                                 {"/dev/null", "not a regular file"},
                                 {"/dev/full", "not a regular file"},
                                 {folder / long_name, "too long"},
                                 {"", "needs a name"}};
  for (const Row& row : rows) {
    CAPTURE(row.path);
    const Caught caught = Catching([&] { CheckWritable(row.path); });
    CHECK(caught.code == ExitCode::kCannotWrite);
    CHECK(caught.Says(row.what));
  }
  CHECK(fs::is_fifo(folder / "fifo"));
  CHECK(fs::is_character_file("/dev/null"));
  CHECK(folder.file_count() == 4);
}

TEST_CASE("read-only folders and files are refused") {
  if (geteuid() == 0) return;  // to whom nothing is read-only
  const TestFolder folder;
  WriteBytes(folder / "file", kOld);
  fs::permissions(folder / "file", fs::perms::owner_read);
  CHECK(Catching([&] { CheckWritable(folder / "file"); }).Says("exists and is read-only"));
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  const Caught caught = Catching([&] { CheckWritable(folder / "new"); });
  CHECK(caught.code == ExitCode::kCannotWrite);
  CHECK(caught.Says("is not writable"));
}

TEST_CASE("a target that becomes a folder meanwhile is not replaced") {
  const TestFolder folder;
  OutputFile file(folder / "a.png");
  file.Write(0, kNew);
  fs::create_directory(folder / "a.png");
  CHECK(Catching([&] { file.Commit(); }).code == ExitCode::kCannotWrite);
  CHECK(fs::is_directory(folder / "a.png"));
}

TEST_CASE("a full disk leaves the old file and nothing else") {
  const TestFolder folder;
  const std::string path = folder / "a.png";
  WriteBytes(path, kOld);
  {
    const FileSizeLimit limit(4096);
    OutputFile file(path);
    file.Write(0, std::vector<uint8_t>(4000));
    const Caught caught = Catching([&] { file.Write(4000, std::vector<uint8_t>(4000)); });
    CHECK(caught.code == ExitCode::kCannotWrite);
    CHECK(caught.Says("cannot write"));
    CHECK(caught.Says("make room"));
  }
  CHECK(ReadBytes(path) == kOld);
  CHECK(folder.file_count() == 1);
}

TEST_CASE("checking a path leaves nothing") {
  const TestFolder folder;
  CheckWritable(folder / "a.png");
  CHECK(folder.file_count() == 0);
  WriteBytes(folder / "a.png", kOld);
  CheckWritable(folder / "a.png");
  CHECK(ReadBytes(folder / "a.png") == kOld);
}

}  // namespace
}  // namespace nacre
