// SPDX-License-Identifier: Apache-2.0
// base/version.h: the version of this build. Written at build time.
#pragma once

namespace nacre {

extern const char kVersion[];  // "0.2.0"
extern const char kCommit[];   // abbreviated commit, or "unknown" outside a git checkout

}  // namespace nacre
