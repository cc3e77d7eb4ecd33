// SPDX-License-Identifier: Apache-2.0
// view/page_parts.h: the sources of the page, compiled in: view/html, with the report's style and
// viewer.
#pragma once

#include <string_view>

namespace nacre {

std::string_view ViewTemplate();  // with placeholders {{name}}
std::string_view ViewStyle();
std::string_view ViewScript();

// The script of pages of images, in addition to the report's.
std::string_view ViewImagesScript();

// Hexadecimal digests, by which the page's policy allows only this style and this script.
std::string_view ViewStyleSha256();
std::string_view ViewScriptSha256();
std::string_view ViewImagesScriptSha256();

// The built-in scene.
std::string_view ViewFirstScene();

}  // namespace nacre
