// SPDX-License-Identifier: Apache-2.0
// view/mailbox_test.cc: which requests wait, and what messages say.
#include "view/mailbox.h"

#include "base/error.h"
#include "catch.h"

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
  const auto name = [](size_t i) { return "/a" + std::to_string(i); };
  for (size_t i = 0; i < Mailbox::kMaxWaiting; ++i) mailbox.Add(Set(name(i), 1));
  CHECK_THROWS_AS(mailbox.Add(Set("/b", 1)), Error);
  CHECK_THROWS_AS(mailbox.Add({1, HistoryRequest::kUndo}), Error);
  // The newest value of what waits is taken still, whatever its gesture; and nobody is kept out.
  mailbox.Add(Set("/a7", 2, 99));
  for (ClientId client = 1; client <= 16; ++client) {
    for (int i = 0; i < 3; ++i) {
      mailbox.Add({client, WelcomeRequest{}});
      mailbox.Add({client, LookRequest{"neutral", "", 0}});
      mailbox.Add({client, ExplainRequest{1, i}});
    }
  }
  const std::vector<Request> waiting = mailbox.Take();
  CHECK(waiting.size() == Mailbox::kMaxWaiting + size_t{16} * 3);
  CHECK(std::get<SetRequest>(waiting[Mailbox::kMaxWaiting - 1].what).value == 2);
  CHECK(std::get<ExplainRequest>(waiting.back().what).y == 2);
}

TEST_CASE("of a flood of drags of one slider the newest value is kept") {
  Mailbox mailbox;
  for (size_t i = 1; i <= 10000; ++i) mailbox.Add(Set("/a", static_cast<double>(i), i));
  const std::vector<Request> waiting = mailbox.Take();
  CHECK(waiting.size() <= Mailbox::kCrowded + 1);
  CHECK(std::get<SetRequest>(waiting.back().what).value == 10000);
  // Of two sliders, in whatever order they come.
  for (size_t i = 1; i <= 10000; ++i) {
    mailbox.Add(Set(i % 2 == 0 ? "/a" : "/b", static_cast<double>(i), i));
  }
  double a = 0, b = 0;
  const std::vector<Request> both = mailbox.Take();
  for (const Request& request : both) {
    const auto& set = std::get<SetRequest>(request.what);
    (set.pointer == "/a" ? a : b) = set.value.get<double>();
  }
  CHECK(both.size() <= Mailbox::kCrowded + 1);
  CHECK(a == 10000);
  CHECK(b == 9999);
}

TEST_CASE("what waits is bounded by its size") {
  Mailbox mailbox;
  constexpr size_t kHalf = Mailbox::kMaxWaitingBytes / 2;
  const auto of_size = [](const char* pointer, size_t bytes) {
    Request request = Set(pointer, 1);
    request.bytes = bytes;
    return request;
  };
  mailbox.Add(of_size("/a", 1));
  mailbox.Add(of_size("/b", kHalf));
  mailbox.Add(of_size("/a", kHalf));
  // Nor by a larger value in the place of a smaller one, which stays then.
  CHECK_THROWS_AS(mailbox.Add(of_size("/a", kHalf + 1)), Error);
  CHECK_THROWS_AS(mailbox.Add(of_size("/c", 1)), Error);
  mailbox.Add(of_size("/b", 1));
  CHECK(mailbox.Take().size() == 2);
}

TEST_CASE("who has gone needs no answers") {
  Mailbox mailbox;
  mailbox.Add(Set("/a", 1));
  mailbox.Add({1, WelcomeRequest{}});
  mailbox.Add({2, WelcomeRequest{}});
  mailbox.Forget(1);
  const std::vector<Request> waiting = mailbox.Take();
  REQUIRE(waiting.size() == 2);
  CHECK(waiting[0].ChangesScene());
  CHECK(waiting[1].client == 2);
}

TEST_CASE("pointers that no scene has are refused before they are followed") {
  const auto read = [](const std::string& key, const std::string& pointer) {
    const Json message = {{key, pointer},
                          {key == "set" ? "value" : "model", key == "set" ? "1" : "phong"}};
    return ReadRequest(1, message.dump());
  };
  std::string deep;
  for (size_t i = 0; i < kMaxJsonDepth; ++i) deep += "/a";
  for (const char* const key : {"set", "convert"}) {
    CHECK_NOTHROW(read(key, deep));
    CHECK_NOTHROW(read(key, "/" + std::string(kMaxPointerBytes - 1, 'x')));
    CHECK_THROWS_AS(read(key, deep + "/a"), Error);
    CHECK_THROWS_AS(read(key, "/" + std::string(kMaxPointerBytes, 'x')), Error);
  }
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
  CHECK(std::get<OfferedRequest>(ReadRequest(1, R"({"offered": "discard"})").what) ==
        OfferedRequest::kDiscard);
  CHECK(ReadRequest(1, R"({"history": "undo"})").bytes == 19);
  for (const char* bad :
       {"", "{}", "[]", "3", R"({"set": "/a"})", R"({"set": "/a", "value": 1, "x": 2})",
        R"({"look": "none", "exposure": 61})", R"({"history": 1})",
        R"({"set": "/a", "value": 1, "serial": 0.5})"}) {
    CHECK_THROWS_AS(ReadRequest(1, bad), Error);
  }
}

}  // namespace
}  // namespace nacre
