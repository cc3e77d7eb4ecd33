// SPDX-License-Identifier: Apache-2.0
// view/token.h: the secret in the address that gives access to a page.
#pragma once

#include <string>
#include <string_view>

namespace nacre {

// 128 random bits from the kernel, as 32 hexadecimal digits.
std::string MakeToken();

// The token of a server at this port. It is kept for the next server in the folder of the user's
// session (XDG_RUNTIME_DIR), so that pages can reconnect after a restart. A new token if there is
// no such folder, or no file that only the user can read.
std::string KeptToken(unsigned port);

// Compares tokens in a time that depends only on the length of `given`.
bool SameToken(std::string_view token, std::string_view given);

}  // namespace nacre
