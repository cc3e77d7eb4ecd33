// SPDX-License-Identifier: Apache-2.0
// view/page.h: the HTML pages that are served.
#pragma once

#include <string>

#include "color/display.h"
#include "view/server.h"

namespace nacre {

// The page for a scene, which is sent later through the socket. `generator`: "nacre 0.2.0
// (c0ffee)".
ServedPage MakeViewPage(const std::string& title, const std::string& generator,
                        const DisplaySettings& display);

// A report's page with a script that reacts to changes of its files: the server sends {"reload":
// true} when they have changed, and {"banner": TEXT} when they cannot be read.
ServedPage MakeImagesPage(std::string report);

}  // namespace nacre
