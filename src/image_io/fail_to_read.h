// SPDX-License-Identifier: Apache-2.0
// image_io/fail_to_read.h: the error that all readers of images throw.
#pragma once

#include <string>

#include "base/error.h"

namespace nacre {

[[noreturn]] inline void FailToRead(const std::string& path, const std::string& reason) {
  throw Error(ExitCode::kBadInput, path, "cannot be read: " + reason);
}

}  // namespace nacre
