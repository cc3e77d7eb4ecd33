// SPDX-License-Identifier: Apache-2.0
// view/token_test.cc: who is let in.
#include "view/token.h"

#include <set>

#include "catch.h"

namespace nacre {
namespace {

TEST_CASE("tokens are 32 digits, each another") {
  std::set<std::string> seen;
  for (int i = 0; i < 100; ++i) {
    const std::string token = MakeToken();
    CHECK(token.size() == 32);
    CHECK(token.find_first_not_of("0123456789abcdef") == std::string::npos);
    CHECK(seen.insert(token).second);
  }
}

TEST_CASE("only the same token is the same") {
  const std::string token = MakeToken();
  CHECK(SameToken(token, token));
  CHECK_FALSE(SameToken(token, ""));
  CHECK_FALSE(SameToken(token, token + token));
  CHECK_FALSE(SameToken(token, token.substr(1)));
  for (size_t i = 0; i < token.size(); ++i) {
    std::string other = token;
    other[i] = other[i] == '0' ? '1' : '0';
    CHECK_FALSE(SameToken(token, other));
  }
  CHECK_FALSE(SameToken("", ""));  // no token lets nobody in
}

}  // namespace
}  // namespace nacre
