#!/bin/sed -Ef
# SPDX-License-Identifier: Apache-2.0
# The comments of nacre.h as Doxygen wants them: above what they are about, or behind it. The first
# one is the main page. Rules, the licence and marks for clang-tidy are none of them.
/^\/\/ (SPDX|----)/d
s|  // NOLINT.*||
s|^// nacre\.h: |/// @mainpage nacre.h\n/// |
s|^//   |///       |
s|^( *)// |\1/// |
s|^( *)//$|\1///|
/^ *\/\/\//! s|([^ /:"]) +// |\1  ///< |
# No quotations and no dashes.
s|^( *///<?) > |\1 \\> |
s|(///<) > |\1 \\> |
/^ *\/\/\/|\/\/\/</s| --([a-z])| \\--\1|g
