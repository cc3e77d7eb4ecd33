// SPDX-License-Identifier: Apache-2.0
#include "view/answer.h"

#include <exception>
#include <new>

#include "base/cancel.h"
#include "base/printable.h"
#include "scene_io/json_text.h"

namespace nacre {

std::string FaultMessage(const std::string& pointer, const Error& error) {
  Json faults = Json::array();
  for (const Fault& fault : error.faults()) {
    faults.push_back({{"where", Printable(fault.where)},
                      {"what", Printable(fault.what)},
                      {"hint", Printable(fault.hint)}});
  }
  return JsonText({{"fault", pointer}, {"faults", std::move(faults)}});
}

std::string CaughtFault(const std::string& pointer) {
  try {
    throw;
  } catch (const Error& error) {
    return FaultMessage(pointer, error);
  } catch (const Cancelled&) {
    return FaultMessage(pointer, Error(ExitCode::kUsage, "", "the scene has changed meanwhile",
                                       "ask for it again"));
  } catch (const std::bad_alloc&) {
    return FaultMessage(pointer, Error(ExitCode::kInternal, "", "out of memory",
                                       "a smaller picture or scene needs less"));
  } catch (const std::exception& error) {
    return FaultMessage(pointer, Error(ExitCode::kInternal, "", error.what()));
  }
}

}  // namespace nacre
