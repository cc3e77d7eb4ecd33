// SPDX-License-Identifier: Apache-2.0
// view/mailbox_test.cc: which requests wait, and what messages say.
#include "view/mailbox.h"

#include <catch2/catch.hpp>

#include "base/error.h"

namespace nacre {
namespace {

Request Set(const std::string& pointer, double value, uint64_t gesture = 1) {
  return {1, SetRequest{pointer, value, gesture, 0}};
}

// The pointers and values that wait, in order.
std::string Waiting(Mailbox* mailbox) {
  std::string text;
  for (const Request& request : mailbox->Take()) {
    if (const auto* set = std::get_if<SetRequest>(&request.what)) {
      text += set->pointer + "=" + set->value.dump() + " ";
    } else {
      text += "other ";
    }
  }
  return text;
}

TEST_CASE("of values for one pointer the newest is kept") {
  Mailbox mailbox;
  mailbox.Add(Set("/a", 1));
  mailbox.Add(Set("/b", 2));
  mailbox.Add(Set("/a", 3));
  CHECK(Waiting(&mailbox) == "/b=2.0 /a=3.0 ");
  CHECK(mailbox.empty());
}

TEST_CASE("values that others between depend on are kept") {
  Mailbox mailbox;
  mailbox.Add(Set("/a", 1));
  mailbox.Add(Set("/a/b", 2));
  mailbox.Add(Set("/a", 3));
  CHECK(Waiting(&mailbox) == "/a=1.0 /a/b=2.0 /a=3.0 ");
  mailbox.Add(Set("/a", 1));
  mailbox.Add({1, HistoryRequest::kUndo});
  mailbox.Add(Set("/a", 3));
  CHECK(Waiting(&mailbox) == "/a=1.0 other /a=3.0 ");
  mailbox.Add(Set("/ab", 1));  // no part of /a
  mailbox.Add(Set("/a", 2));
  mailbox.Add(Set("/ab", 3));
  CHECK(Waiting(&mailbox) == "/a=2.0 /ab=3.0 ");
}

TEST_CASE("two drags are two steps") {
  Mailbox mailbox;
  mailbox.Add(Set("/a", 1, 1));
  mailbox.Add(Set("/a", 2, 2));
  CHECK(Waiting(&mailbox) == "/a=1.0 /a=2.0 ");
}

TEST_CASE("a page cannot fill the mailbox") {
  Mailbox mailbox;
  for (size_t i = 0; i < Mailbox::kMaxWaiting; ++i) mailbox.Add(Set("/a" + std::to_string(i), 1));
  CHECK_THROWS_AS(mailbox.Add(Set("/b", 1)), Error);
}

TEST_CASE("messages") {
  const Request set =
      ReadRequest(7, R"({"set": "/image/spp", "value": 4, "gesture": 9, "serial": 3})");
  CHECK(set.client == 7);
  CHECK(std::get<SetRequest>(set.what).pointer == "/image/spp");
  CHECK(std::get<SetRequest>(set.what).value == 4);
  CHECK(std::get<SetRequest>(set.what).gesture == 9);
  CHECK(std::get<SetRequest>(set.what).serial == 3);
  CHECK(set.ChangesPicture());
  const Request look = ReadRequest(1, R"({"look": "agx", "exposure": -2, "layer": "N"})");
  CHECK(std::get<LookRequest>(look.what).tone == "agx");
  CHECK(std::get<LookRequest>(look.what).exposure == -2);
  CHECK(std::get<HistoryRequest>(ReadRequest(1, R"({"history": "redo"})").what) ==
        HistoryRequest::kRedo);
  for (const char* bad :
       {"", "{}", "[]", "3", R"({"set": "/a"})", R"({"set": "/a", "value": 1, "x": 2})",
        R"({"look": "none", "exposure": 61})", R"({"history": 1})",
        R"({"set": "/a", "value": 1, "serial": 0.5})"}) {
    CHECK_THROWS_AS(ReadRequest(1, bad), Error);
  }
}

}  // namespace
}  // namespace nacre
