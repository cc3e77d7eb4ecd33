// SPDX-License-Identifier: Apache-2.0
// view/private_file.h: small files that only the user can read, and folders for them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace nacre {

// The folder of the user's session (XDG_RUNTIME_DIR), whose contents are deleted with the session.
// Empty if there is none to which only the user has access.
std::string SessionFolder();

// nacre's folder for data that outlives a session: below XDG_STATE_HOME, or ~/.local/state. Created
// if necessary. Empty if it cannot be created, or if others have access to it.
std::string StateFolder();

// The text of a private file; nullopt if it is missing, longer than max_bytes, not a regular file
// of the user's own, or readable by others.
std::optional<std::string> ReadPrivateFile(const std::string& path, size_t max_bytes);

// Writes the file atomically: the old file stays until the new one is complete. For one writer at a
// time. Returns whether it succeeded.
bool WritePrivateFile(const std::string& path, std::string_view text);

}  // namespace nacre
