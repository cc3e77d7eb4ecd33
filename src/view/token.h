// SPDX-License-Identifier: Apache-2.0
// view/token.h: the secret in the address by which a page is let in.
#pragma once

#include <string>
#include <string_view>

namespace nacre {

// 128 random bits of the kernel's, as 32 hexadecimal digits.
std::string MakeToken();

// The token of a server at this port, kept for the next one in the folder of the user's session
// (XDG_RUNTIME_DIR), so that pages find the server again after it has been started anew. A new one
// where there is no such folder, or no file that the user alone can read.
std::string KeptToken(unsigned port);

// Whether they are equal, in a time that depends on the length of `given` alone.
bool SameToken(std::string_view token, std::string_view given);

}  // namespace nacre
