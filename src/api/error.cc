// SPDX-License-Identifier: Apache-2.0
// api/error.cc: errors of the public API, and information about this build and machine.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "api/border.h"
#include "base/target.h"
#include "base/version.h"
#include "scene_io/schema.h"

namespace nacre::v0 {

Error::Error(int exit_code, std::vector<Fault> faults, std::string message)
    : exit_code_(exit_code), faults_(std::move(faults)), message_(std::move(message)) {}
Error::Error(const Error&) = default;
Error& Error::operator=(const Error&) = default;
Error::~Error() = default;
const char* Error::what() const noexcept { return message_.c_str(); }

Error ToPublic(const nacre::Error& error) {
  std::vector<Fault> faults;
  faults.reserve(error.faults().size());
  for (const nacre::Fault& fault : error.faults()) {
    faults.push_back({fault.where, fault.what, fault.hint});
  }
  return {static_cast<int>(error.code()), std::move(faults), error.what()};
}

std::string Version() { return kVersion; }

std::vector<std::string> SupportedTargets() {
  std::vector<std::string> names;
  for (const Target target : nacre::SupportedTargets()) names.push_back(TargetName(target));
  return names;
}

std::string ActiveTarget() { return TargetName(nacre::ActiveTarget()); }

void SetTarget(const std::string& name) {
  AtBorder([&] {
    for (const Target target : nacre::SupportedTargets()) {
      if (TargetName(target) == name) return PinTarget(target);
    }
    throw nacre::Error(ExitCode::kUsage, "SetTarget", "this machine cannot run " + name,
                       fmt::format("it can run {}", fmt::join(SupportedTargets(), ", ")));
  });
}

std::string SceneSchema() { return std::string(nacre::SceneSchema()); }

}  // namespace nacre::v0
