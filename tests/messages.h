// SPDX-License-Identifier: Apache-2.0
// tests/messages.h: what is said of a mistake.
#pragma once

#include <functional>
#include <string>

#include "base/error.h"
#include "catch.h"

namespace nacre {

// The text of the Error that the action throws, which must have this code; "no error" without one.
inline std::string ErrorOf(const std::function<void()>& action,
                           ExitCode code = ExitCode::kBadInput) {
  try {
    action();
  } catch (const Error& error) {
    CHECK(error.code() == code);
    return error.what();
  }
  return "no error";
}

inline bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// Whether the message has this part; a failing check shows the message.
inline bool Tells(const std::string& message, const std::string& part) {
  INFO(message);
  const bool tells = Contains(message, part);
  CHECK(tells);
  return tells;
}

}  // namespace nacre
