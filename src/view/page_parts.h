// SPDX-License-Identifier: Apache-2.0
// view/page_parts.h: the sources of the view's page, compiled in: view/html, with the report's
// style and viewer.
#pragma once

#include <string_view>

namespace nacre {

std::string_view ViewTemplate();  // with {{names}} of what goes in
std::string_view ViewStyle();
std::string_view ViewScript();

// What pages of images have besides the report's script.
std::string_view ViewImagesScript();

// Hexadecimal digests, by which the page's policy allows these and no other style and script.
std::string_view ViewStyleSha256();
std::string_view ViewScriptSha256();
std::string_view ViewImagesScriptSha256();

// The scene that is shown without any other.
std::string_view ViewFirstScene();

}  // namespace nacre
