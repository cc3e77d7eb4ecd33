// SPDX-License-Identifier: Apache-2.0
// image_io/output_file.h: files that appear completely or not at all.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace nacre {

// A file being written. Before Commit, nothing is visible under its name, and a file that was there
// remains; without Commit, nothing remains of the new file.
//
// The bytes go to an anonymous file in the target's folder (O_TMPFILE), which vanishes with the
// process however that ends. If the file system does not support that, they go to a hidden file
// beside the target (".name.XXXXXX.tmp"), which the destructor removes.
class OutputFile {
 public:
  // Opens the file before anything is computed for it. Symbolic links are followed: the file that
  // they point to is replaced, not the links. Throws Error (kCannotWrite) if the folder is missing
  // or not writable, or if the target exists and is read-only or not a regular file: renaming over
  // a device would replace the device.
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  // Writes bytes at `offset` from the start of the file. May be called from any thread. Throws
  // Error (kCannotWrite), e.g. when the disk is full.
  void Write(uint64_t offset, std::span<const uint8_t> bytes);

  // Gives the file its name. If that replaces a file, the new one gets the mode of the old one, and
  // its owner, group, access control list and other extended attributes as far as this process may
  // set them. With `sync`, the file has reached the disk before that. Nothing may be written
  // afterwards. Throws Error (kCannotWrite), and then leaves the old file.
  void Commit(bool sync = false);

 private:
  [[noreturn]] void Fail(const std::string& what, int error) const;
  // Links the anonymous file to `name`. On failure, returns false and sets errno.
  bool LinkTo(const std::string& name) const;
  void LinkBeside();
  void Close();

  std::string path_;    // as the user wrote it, for messages
  std::string target_;  // path_ with symbolic links resolved
  std::string beside_;  // the temporary name; empty while the file is anonymous
  int descriptor_ = -1;
};

// Throws what OutputFile's constructor throws. Leaves no file.
void CheckWritable(const std::string& path);

// A string that is the same for all paths of one file, through symbolic and hard links, even if the
// file does not exist yet, only its folder; and that differs between files.
std::string FileIdentity(const std::string& path);

}  // namespace nacre
