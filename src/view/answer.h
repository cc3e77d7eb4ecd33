// SPDX-License-Identifier: Apache-2.0
// view/answer.h: error messages for pages.
#pragma once

#include <string>

#include "base/error.h"

namespace nacre {

// The message about the faults of a request for the value at `pointer`, or of any request if it is
// empty.
std::string FaultMessage(const std::string& pointer, const Error& error);

// The message about the exception that is being handled; to be called in a catch block.
std::string CaughtFault(const std::string& pointer);

}  // namespace nacre
