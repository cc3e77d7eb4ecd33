// SPDX-License-Identifier: Apache-2.0
// image_io/output_file.h: files that appear whole or not at all.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace nacre {

// A file being written. Until Commit nothing is seen under its name, and what was there before
// stays; without a Commit nothing remains.
//
// The bytes go to an anonymous file in the target's folder (O_TMPFILE), which vanishes with the
// process however that ends. Where the file system has none, they go to a hidden file beside the
// target (".name.XXXXXX.tmp"), which the destructor removes.
class OutputFile {
 public:
  // Opens the file before anything is computed for it. Symbolic links are followed: what they
  // point to is replaced, not they. Throws Error (kCannotWrite) if the folder is missing or not
  // writable, or if the target exists and is read-only or anything but a regular file: renaming
  // over a device would replace the device.
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  // Writes bytes at `offset` from the start. Any thread. Throws Error (kCannotWrite), e.g. when
  // the disk is full.
  void Write(uint64_t offset, std::span<const uint8_t> bytes);

  // Gives the file its name, replacing what had it: then with that one's mode, and its owner,
  // group, access control list and other extended attributes as far as this process may set them.
  // With `sync`, only once it has reached the disk. Nothing may be written afterwards. Throws Error
  // (kCannotWrite) and leaves the old file.
  void Commit(bool sync = false);

 private:
  [[noreturn]] void Fail(const std::string& what, int error) const;
  // Links the anonymous file to `name`; errno tells why not.
  bool LinkTo(const std::string& name) const;
  void LinkBeside();
  void Close();

  std::string path_;    // as the user wrote it, for messages
  std::string target_;  // with symbolic links followed
  std::string beside_;  // the temporary name; empty while the file is anonymous
  int descriptor_ = -1;
};

// Throws what OutputFile's constructor throws. Leaves nothing.
void CheckWritable(const std::string& path);

// The same text for every spelling of a file's path, links of both kinds included, whether the file
// is there already or its folder only; another text for every other file.
std::string FileIdentity(const std::string& path);

}  // namespace nacre
