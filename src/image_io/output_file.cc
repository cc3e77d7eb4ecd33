// SPDX-License-Identifier: Apache-2.0
#include "image_io/output_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <random>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include "base/error.h"

namespace nacre {
namespace {

namespace fs = std::filesystem;

std::string ErrnoText(int error) { return std::generic_category().message(error); }

std::string Folder(const std::string& target) {
  const std::string folder = fs::path(target).parent_path();
  return folder.empty() ? "." : folder;
}

// The file that `path` leads to through symbolic links; it need not exist yet.
std::string FollowLinks(const std::string& path) {
  constexpr int kMaxLinks = 40;  // as many as the kernel follows
  fs::path target = path;
  for (int i = 0; i < kMaxLinks; ++i) {
    std::error_code error;
    if (!fs::is_symlink(fs::symlink_status(target, error))) return target;
    const fs::path next = fs::read_symlink(target, error);
    if (error) return target;
    target = target.parent_path() / next;
  }
  throw Error(ExitCode::kCannotWrite, path, "too many symbolic links");
}

// Throws unless `target` does not exist or is a writable regular file.
void CheckTarget(const std::string& path, const std::string& target) {
  if (target.empty()) throw Error(ExitCode::kCannotWrite, path, "an output file needs a name");
  struct stat status;
  if (stat(target.c_str(), &status) != 0) {
    if (errno == ENOENT || errno == ENOTDIR) return;  // the folder is checked on opening
    throw Error(ExitCode::kCannotWrite, path, "cannot write: " + ErrnoText(errno));
  }
  if (S_ISDIR(status.st_mode)) {
    throw Error(ExitCode::kCannotWrite, path, "is a folder", "name a file in it");
  }
  if (!S_ISREG(status.st_mode)) {
    throw Error(ExitCode::kCannotWrite, path, "exists and is not a regular file",
                "an output replaces the file of its name; choose another name");
  }
  if (access(target.c_str(), W_OK) != 0) {
    throw Error(ExitCode::kCannotWrite, path, "exists and is read-only",
                "choose another name, or make it writable");
  }
}

// An anonymous file in `folder`; -1 if not supported. It is named through /proc, which must be
// mounted.
int OpenAnonymous(const std::string& folder) {
  const int descriptor = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  if (descriptor < 0) return -1;
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  if (access(link.c_str(), F_OK) == 0) return descriptor;
  close(descriptor);
  return -1;
}

// ".name.XXXXXX.tmp" in the target's folder, with random characters XXXXXX.
std::string NameBeside(const std::string& target) {
  constexpr char kDigits[] = "0123456789abcdefghijklmnopqrstuvwxyz";
  constexpr size_t kMaxName = 200;  // file systems allow 255
  std::random_device random;
  std::string suffix;
  for (int i = 0; i < 6; ++i) suffix += kDigits[random() % (sizeof(kDigits) - 1)];
  const std::string name = fs::path(target).filename().string().substr(0, kMaxName);
  return Folder(target) + "/." + name + "." + suffix + ".tmp";
}

// Copies all extended attributes, including access control lists, that this process may set.
void CopyAttributes(const std::string& from, int descriptor) {
  const ssize_t size = listxattr(from.c_str(), nullptr, 0);
  if (size <= 0) return;
  std::string names(static_cast<size_t>(size), '\0');
  const ssize_t listed = listxattr(from.c_str(), names.data(), names.size());
  std::vector<char> value;
  for (ssize_t at = 0; at < listed;) {
    const char* const name = names.data() + at;
    at += static_cast<ssize_t>(std::strlen(name)) + 1;
    const ssize_t length = getxattr(from.c_str(), name, nullptr, 0);
    if (length < 0) continue;
    value.resize(static_cast<size_t>(length));
    const ssize_t got = getxattr(from.c_str(), name, value.data(), value.size());
    if (got >= 0) fsetxattr(descriptor, name, value.data(), static_cast<size_t>(got), 0);
  }
}

// Gives a new file the owner, group, mode and attributes of the one that it replaces, if there is
// one. If this process may not change the owner, it remains the owner, and then the file's group
// must not get the permissions that another group had.
void TakeOver(const std::string& replaced, int descriptor) {
  struct stat status;
  if (stat(replaced.c_str(), &status) != 0) return;
  mode_t mode = status.st_mode & (S_IRWXU | S_IRWXG | S_IRWXO);
  if (fchown(descriptor, status.st_uid, status.st_gid) != 0 &&
      fchown(descriptor, static_cast<uid_t>(-1), status.st_gid) != 0) {
    struct stat own;
    const bool same_group = fstat(descriptor, &own) == 0 && own.st_gid == status.st_gid;
    if (!same_group) mode = (mode & ~static_cast<mode_t>(S_IRWXG)) | (mode & S_IRWXO) << 3;
  }
  CopyAttributes(replaced, descriptor);
  // Comes last, since changes of owner or access control list may change the mode. A file system
  // without modes refuses it.
  [[maybe_unused]] const int ignored = fchmod(descriptor, mode);
}

// Attempts to find an unused temporary name: one nearly always suffices.
constexpr int kNameAttempts = 100;

}  // namespace

OutputFile::OutputFile(const std::string& path) : path_(path), target_(FollowLinks(path)) {
  CheckTarget(path_, path_);  // checks links that only the kernel resolves, like /dev/stdout
  CheckTarget(path_, target_);
  const std::string folder = Folder(target_);
  descriptor_ = OpenAnonymous(folder);
  // A file that replaces one that others may not read must not be readable by them before TakeOver
  // has set its mode.
  const mode_t mode = access(target_.c_str(), F_OK) == 0 ? 0600 : 0666;
  for (int i = 0; descriptor_ < 0 && i < kNameAttempts; ++i) {
    beside_ = NameBeside(target_);
    descriptor_ = open(beside_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, mode);
    if (descriptor_ < 0 && errno != EEXIST) break;
  }
  if (descriptor_ >= 0) return;
  switch (errno) {
    case ENOENT:
      throw Error(ExitCode::kCannotWrite, path_, "the folder " + folder + " does not exist",
                  "mkdir -p " + folder);
    case ENOTDIR:
      throw Error(ExitCode::kCannotWrite, path_, folder + " is not a folder");
    case EACCES:
    case EPERM:
    case EROFS:
      throw Error(ExitCode::kCannotWrite, path_, "the folder " + folder + " is not writable");
    default:
      Fail("cannot write into the folder " + folder, errno);
  }
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (!beside_.empty()) unlink(beside_.c_str());
}

void OutputFile::Write(uint64_t offset, std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written =
        pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) Fail("cannot write", written < 0 ? errno : ENOSPC);
    offset += static_cast<uint64_t>(written);
    bytes = bytes.subspan(static_cast<size_t>(written));
  }
}

void OutputFile::Commit(bool sync) {
  CheckTarget(path_, target_);  // it may have changed meanwhile
  TakeOver(target_, descriptor_);
  if (sync && fsync(descriptor_) != 0) Fail("cannot write", errno);
  // A new name is taken atomically by a link. An existing file can only be replaced by a rename.
  if (beside_.empty() && LinkTo(target_)) {
    Close();
  } else {
    if (beside_.empty()) LinkBeside();
    Close();
    if (rename(beside_.c_str(), target_.c_str()) != 0) Fail("cannot replace", errno);
    beside_.clear();
  }
  if (!sync) return;
  const int folder = open(Folder(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;  // a folder that is not readable cannot be synced
  fsync(folder);
  close(folder);
}

bool OutputFile::LinkTo(const std::string& name) const {
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor_);
  return linkat(AT_FDCWD, link.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

void OutputFile::LinkBeside() {
  for (int i = 0; i < kNameAttempts; ++i) {
    const std::string name = NameBeside(target_);
    if (LinkTo(name)) {
      beside_ = name;
      return;
    }
    if (errno != EEXIST) break;
  }
  Fail("cannot name the finished file", errno);
}

void OutputFile::Close() {
  const int descriptor = descriptor_;
  descriptor_ = -1;
  // Network file systems report a full disk only now.
  if (close(descriptor) != 0 && errno != EINTR) Fail("cannot write", errno);
}

void OutputFile::Fail(const std::string& what, int error) const {
  const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
  throw Error(ExitCode::kCannotWrite, path_, what + ": " + ErrnoText(error),
              full ? "make room, or write elsewhere" : "");
}

void CheckWritable(const std::string& path) { const OutputFile probe(path); }

std::string FileIdentity(const std::string& path) {
  struct stat status;
  if (stat(path.c_str(), &status) == 0) {
    return fmt::format("{}:{}", status.st_dev, status.st_ino);
  }
  try {
    const std::string target = FollowLinks(path);
    if (stat(Folder(target).c_str(), &status) != 0) return path;
    return fmt::format("{}:{}/{}", status.st_dev, status.st_ino,
                       fs::path(target).filename().string());
  } catch (const Error&) {  // a cycle of links is reported on opening the file
    return path;
  }
}

}  // namespace nacre
