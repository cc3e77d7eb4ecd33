// SPDX-License-Identifier: Apache-2.0
// view/token.h: the secret in the address by which a page is let in.
#pragma once

#include <string>
#include <string_view>

namespace nacre {

// 128 random bits of the kernel's, as 32 hexadecimal digits.
std::string MakeToken();

// Whether they are equal, in a time that depends on the length of `given` alone.
bool SameToken(std::string_view token, std::string_view given);

}  // namespace nacre
