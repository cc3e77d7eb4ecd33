// SPDX-License-Identifier: Apache-2.0
// view/page.h: the page that is served.
#pragma once

#include <string>

#include "color/display.h"
#include "view/server.h"

namespace nacre {

// All of it but the scene, which comes through the socket. `generator`: "nacre 0.2.0 (c0ffee)".
ServedPage MakeViewPage(const std::string& title, const std::string& generator,
                        const std::string& tone, double exposure);

// A report's page, with a script by which it follows its files: it is told
// {"reload": true} when they have changed, and {"banner": TEXT} when they cannot be read.
ServedPage MakeImagesPage(std::string report);

}  // namespace nacre
