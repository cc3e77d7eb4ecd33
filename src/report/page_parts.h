// SPDX-License-Identifier: Apache-2.0
// report/page_parts.h: the sources of the page, compiled in: report/html.
#pragma once

#include <string_view>

namespace nacre {

std::string_view PageTemplate();  // with placeholders {{name}}
std::string_view PageStyle();
std::string_view PageScript();

// Hexadecimal digests, by which the page's policy allows only this style and this script.
std::string_view PageStyleSha256();
std::string_view PageScriptSha256();

}  // namespace nacre
