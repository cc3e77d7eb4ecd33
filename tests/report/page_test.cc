// SPDX-License-Identifier: Apache-2.0
// tests/report/page_test.cc: what holds a page together: base64, escapes, its policy.
#include "report/page.h"

#include <nlohmann/json.hpp>

#include "catch.h"
#include "report/page_parts.h"

namespace nacre {
namespace {

std::string Encode(const std::string& text) {
  return Base64(std::span(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
}

TEST_CASE("Base64 is that of RFC 4648, section 10", "[report]") {
  CHECK(Encode("").empty());
  CHECK(Encode("f") == "Zg==");
  CHECK(Encode("fo") == "Zm8=");
  CHECK(Encode("foo") == "Zm9v");
  CHECK(Encode("foob") == "Zm9vYg==");
  CHECK(Encode("fooba") == "Zm9vYmE=");
  CHECK(Encode("foobar") == "Zm9vYmFy");
  CHECK(Encode("\xfb\xff") == "+/8=");
}

TEST_CASE("Text stays text", "[report]") {
  CHECK(EscapeHtml("a<b>&\"c\"") == "a&lt;b&gt;&amp;&quot;c&quot;");
  const std::string html =
      Page().Html("<script>", "me \"&\"", {{"name", "</script><!-- {{style}} \xff"}});
  CHECK(html.find("<title>&lt;script&gt;</title>") != std::string::npos);
  CHECK(html.find("</script><!--") == std::string::npos);
  CHECK(html.find(R"(\u003c/script>\u003c!-- {{style}} \\xff)") != std::string::npos);
}

TEST_CASE("A page shows control characters and obeys none", "[report]") {
  const std::string html =
      Page().Html("\x1b[2J\xe2\x80\xaeü", "nacre", {{"a\x1b", {1, "b\xc2\x9b\x7f漢\nc\td"}}});
  CHECK(html.find("<title>\\u001b[2J\\u202eü</title>") != std::string::npos);
  CHECK(html.find(R"({"a\\u001b":[1,"b\\u009b\\u007f漢\nc\td"]})") != std::string::npos);
}

TEST_CASE("A page has its policy and its blobs", "[report]") {
  Page page;
  CHECK(page.AddBlob({}) == 0);
  CHECK(page.AddBlob({}) == 1);
  const std::string html = page.Html("t", "g", {{"a", 1}});
  CHECK(html.find("default-src 'none'; script-src 'sha256-") != std::string::npos);
  CHECK(html.find("unsafe") == std::string::npos);
  CHECK(html.find("id=\"blob1\"") != std::string::npos);
  CHECK(html.find("\n{{") == std::string::npos);
  CHECK(PageScriptSha256().size() == 64);
}

TEST_CASE("The page's sources name no server", "[report]") {
  for (const std::string_view part : {PageTemplate(), PageStyle()}) {
    CHECK(part.find("http") == part.find("http-equiv"));
  }
  // The one name is that of SVG, which is no address to ask.
  const std::string_view script = PageScript();
  const size_t at = script.find("http");
  CHECK(script.substr(at, 26) == "http://www.w3.org/2000/svg");
  CHECK(script.find("http", at + 1) == std::string_view::npos);
  CHECK(script.find("</script") == std::string_view::npos);
  CHECK(script.find("innerHTML") == std::string_view::npos);
}

}  // namespace
}  // namespace nacre
