// SPDX-License-Identifier: Apache-2.0
// tests/base/printable_test.cc: untrusted text cannot control a terminal.
#include "base/printable.h"

#include <string>

#include "base/error.h"
#include "catch.h"

namespace nacre {
namespace {

TEST_CASE("harmless text stays as it is") {
  for (const char* text :
       {"", "red plastic", "Überzug, größer als ½ µm", "漆器 漢字 かな 한국어", "C:\\new\\table",
        "\"quoted\" 'so'", "שלום עולם", "مرحبا", "👩‍🎨 \xc2\xa0 \xe3\x80\x80",
        "\xf4\x8f\xbf\xbf", "\xef\xbf\xbd", "\xee\x80\x80"}) {
    CHECK(Printable(text) == text);
    CHECK(PrintableLines(text) == text);
  }
}

TEST_CASE("control characters are escaped") {
  using namespace std::string_literals;
  CHECK(Printable("\x1b[31mred\x1b[0m") == "\\u001b[31mred\\u001b[0m");
  CHECK(Printable("a\nb\rc\td\be\af\0g"s) == "a\\nb\\rc\\td\\u0008e\\u0007f\\u0000g");
  CHECK(Printable("\x7f") == "\\u007f");
  CHECK(Printable("\xc2\x9b"
                  "31m") == "\\u009b31m");  // CSI of C1, as UTF-8
  CHECK(Printable("\x9b"
                  "31m") == "\\x9b31m");  // and as terminals of one byte have it
  CHECK(Printable("user\xe2\x80\xae"
                  "exe.png") == "user\\u202eexe.png");
  CHECK(PrintableLines("a\n\tb\r\x1b") == "a\n\tb\\r\\u001b");
}

TEST_CASE("of all characters the control characters are escaped, and no others") {
  const auto encode = [](uint32_t code) {
    const auto byte = [](uint32_t value) { return static_cast<char>(value); };
    if (code < 0x80) return std::string{byte(code)};
    if (code < 0x800) return std::string{byte(0xc0 | code >> 6), byte(0x80 | (code & 63))};
    if (code < 0x10000) {
      return std::string{byte(0xe0 | code >> 12), byte(0x80 | (code >> 6 & 63)),
                         byte(0x80 | (code & 63))};
    }
    return std::string{byte(0xf0 | code >> 18), byte(0x80 | (code >> 12 & 63)),
                       byte(0x80 | (code >> 6 & 63)), byte(0x80 | (code & 63))};
  };
  size_t wrong = 0, spelled = 0;
  for (uint32_t code = 0; code <= 0x10ffff; ++code) {
    if (code >= 0xd800 && code <= 0xdfff) continue;
    const std::string text = encode(code);
    const bool acts = code < 0x20 || (code >= 0x7f && code < 0xa0) ||
                      (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069) ||
                      code == 0x2028 || code == 0x2029;
    const std::string shown = Printable(text);
    spelled += acts;
    wrong += acts ? shown.front() != '\\' || shown.size() < 2 : shown != text;
  }
  CHECK(wrong == 0);
  CHECK(spelled == 32 + 33 + 5 + 4 + 2);
}

TEST_CASE("bytes that are not UTF-8 are escaped one by one") {
  CHECK(Printable("gr\xfc\xdf") == "gr\\xfc\\xdf");       // Latin-1
  CHECK(Printable("\xc0\x9b") == "\\xc0\\x9b");           // overlong
  CHECK(Printable("\xe0\x80\x8a") == "\\xe0\\x80\\x8a");  // overlong line feed
  CHECK(Printable("\xf0\x80\x80\x8a") == "\\xf0\\x80\\x80\\x8a");
  CHECK(Printable("\xed\xa0\x80") == "\\xed\\xa0\\x80");           // a surrogate
  CHECK(Printable("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");  // beyond U+10FFFF
  CHECK(Printable("\xe2\x80") == "\\xe2\\x80");                    // cut off
  CHECK(Printable("\xe2\x1b[m") == "\\xe2\\u001b[m");              // hiding an escape
  CHECK(Printable("\xff\xfe") == "\\xff\\xfe");
}

TEST_CASE("an error has one line for each fault and one for its hint") {
  const Error error(ExitCode::kBadInput,
                    {{"a\n.json: /materials/\x1b[2J", "unknown key \"x\nerror: forged\"", "a\rb"},
                     {"b.json", "is\xe2\x80\xae damaged", ""}});
  CHECK(std::string(error.what()) ==
        "error: a\\n.json: /materials/\\u001b[2J: unknown key \"x\\nerror: forged\"\n"
        "  hint: a\\rb\n"
        "error: b.json: is\\u202e damaged");
  CHECK(error.faults()[0].hint == "a\rb");  // for programs: as it is
}

}  // namespace
}  // namespace nacre
