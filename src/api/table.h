// SPDX-License-Identifier: Apache-2.0
// api/table.h: converts tables of BRDFs between the public header's type and the library's own.
#pragma once

#include "api/border.h"
#include "table/brdf_table.h"

namespace nacre::v0 {

Table ToPublic(nacre::BrdfTable&& table);

// Throws Error (kUsage) unless the numbers fill whole rows, or if the header is no JSON object.
nacre::BrdfTable ToOwn(const Table& table);

}  // namespace nacre::v0
