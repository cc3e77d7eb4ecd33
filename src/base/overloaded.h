// SPDX-License-Identifier: Apache-2.0
// base/overloaded.h: chooses a lambda by a variant's alternative, for std::visit.
#pragma once

namespace nacre {

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

}  // namespace nacre
