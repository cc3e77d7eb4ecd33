// SPDX-License-Identifier: Apache-2.0
// view/private_file.h: small files that the user alone may read, and folders for them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace nacre {

// The folder of the user's session (XDG_RUNTIME_DIR): what is in it is gone with the session. Empty
// where there is none that the user alone has access to.
std::string SessionFolder();

// nacre's folder for what outlives a session: below XDG_STATE_HOME, or ~/.local/state. Made if it
// is not there. Empty where it cannot be made, or is not the user's alone.
std::string StateFolder();

// The text of such a file; nothing if it is missing, longer, not a regular file of the user's own,
// or one that others may read.
std::optional<std::string> ReadPrivateFile(const std::string& path, size_t max_bytes);

// Writes the file whole or not at all: what had the name before stays until then. For one writer at
// a time. Returns whether it did.
bool WritePrivateFile(const std::string& path, std::string_view text);

}  // namespace nacre
