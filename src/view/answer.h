// SPDX-License-Identifier: Apache-2.0
// view/answer.h: what pages are told that is wrong.
#pragma once

#include <string>

#include "base/error.h"

namespace nacre {

// The message of the faults of what a page asked for at `pointer`, or of anything.
std::string FaultMessage(const std::string& pointer, const Error& error);

// The same of whatever has been thrown, from where it is caught.
std::string CaughtFault(const std::string& pointer);

}  // namespace nacre
