// SPDX-License-Identifier: Apache-2.0
#include "view/answer.h"

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

}  // namespace nacre
