// SPDX-License-Identifier: Apache-2.0
// view/edits_test.cc: edits between two trees, and the file that keeps them.
#include "view/edits.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <sys/stat.h>
#include <unistd.h>

#include "catch.h"

namespace nacre {
namespace {

// The pointers and values, in order.
std::string Text(const std::vector<Edit>& edits) {
  std::string text;
  for (const Edit& edit : edits) text += edit.pointer + "=" + edit.value.dump() + " ";
  return text;
}

std::string Between(const char* before, const char* after) {
  return Text(EditsBetween(Json::parse(before), Json::parse(after)));
}

TEST_CASE("edits say what has changed and no more") {
  CHECK(Between(R"({"a": 1, "b": {"c": 2}})", R"({"a": 1, "b": {"c": 2}})") == "");
  CHECK(Between(R"({"a": 1, "b": {"c": 2}})", R"({"a": 1, "b": {"c": 3}})") == "/b/c=3 ");
  CHECK(Between(R"({"a": 1})", R"({"a": 1, "b/~": {"c": 2}})") == R"(/b~1~0={"c":2} )");
  // Gone, or in another order: no value of a member would make it.
  CHECK(Between(R"({"x": {"a": 1, "b": 2}})", R"({"x": {"a": 1}})") == R"(/x={"a":1} )");
  CHECK(Between(R"({"x": {"a": 1, "b": 2}})", R"({"x": {"b": 2, "a": 1}})") ==
        R"(/x={"b":2,"a":1} )");
  CHECK(Between(R"({"a": 1})", "{}") == "={} ");
  CHECK(Between(R"({"p": [1, 2, 3]})", R"({"p": [1, 2, 4]})") == "/p=[1,2,4] ");
  CHECK(Between(R"([{"r": 1}, {"r": 2}])", R"([{"r": 1}, {"r": 3}])") == "/1/r=3 ");
  CHECK(Between(R"([{"r": 1}])", R"([{"r": 1}, {"r": 3}])") == R"(=[{"r":1},{"r":3}] )");
  CHECK(Between("[]", "{}") == "={} ");
}

struct StateHome {
  StateHome()
      : path(std::filesystem::temp_directory_path() /
             ("nacre_edits_test_" + std::to_string(getpid()))) {
    std::filesystem::create_directory(path);
    setenv("XDG_STATE_HOME", path.c_str(), 1);
  }
  ~StateHome() {
    unsetenv("XDG_STATE_HOME");
    std::filesystem::remove_all(path);
  }
  StateHome(const StateHome&) = delete;
  StateHome& operator=(const StateHome&) = delete;

  size_t files() const {
    size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(path / "nacre"))
      count += entry.is_regular_file() ? 1 : 0;
    return count;
  }
  std::filesystem::path path;
};

TEST_CASE("edits are offered to the next server of the same scene alone") {
  const StateHome home;
  std::string why_not;
  const auto open = [&](const char* scene) { return EditsFile::Open(scene, &why_not); };
  {
    const auto first = open("a.json");
    REQUIRE(first != nullptr);
    CHECK(first->offered().empty());
    CHECK(first->Keep({{"/a", 1}, {"/b", "x"}}));
    // More than is read again is not written.
    CHECK_FALSE(first->Keep({{"/c", std::string(size_t{64} << 20, 'x')}}));
    // One server of a scene keeps its edits.
    CHECK(open("./a.json") == nullptr);
    CHECK(why_not.find("another nacre view") != std::string::npos);
    CHECK(open("b.json")->offered().empty());
  }
  CHECK(home.files() == 1);
  for (const auto& entry : std::filesystem::directory_iterator(home.path / "nacre")) {
    struct stat status = {};
    REQUIRE(stat(entry.path().c_str(), &status) == 0);
    CHECK((status.st_mode & 0777) == 0600);
  }
  {
    const auto second = open("a.json");
    CHECK(Text(second->offered()) == "/a=1 /b=\"x\" ");
    // Until somebody says what becomes of them, they are kept with the new ones.
    CHECK(second->Keep({{"/a", 2}}));
  }
  {
    const auto third = open("a.json");
    CHECK(Text(third->offered()) == "/a=1 /b=\"x\" /a=2 ");
    third->ForgetOffered();
    CHECK(third->Keep({}));
  }
  CHECK(home.files() == 0);
  CHECK(open("a.json")->offered().empty());
}

TEST_CASE("files of edits that are not the user's, or no edits, are not believed") {
  namespace fs = std::filesystem;
  const StateHome home;
  std::string why_not;
  { CHECK(EditsFile::Open("a.json", &why_not)->Keep({{"/a", 1}})); }
  const fs::path file = fs::directory_iterator(home.path / "nacre")->path();
  std::string whole;
  std::getline(std::ifstream(file), whole);
  const auto offered = [&] { return EditsFile::Open("a.json", &why_not)->offered().size(); };
  CHECK(offered() == 1);
  fs::permissions(file, fs::perms(0644));
  CHECK(offered() == 0);
  fs::permissions(file, fs::perms(0600));
  for (const std::string& text :
       {std::string(), whole.substr(0, whole.size() / 2), std::string("[1, 2]"),
        std::string(R"({"edits": 3})"), std::string(5000, '[')}) {
    std::ofstream(file) << text;
    CHECK(offered() == 0);
  }
  std::ofstream(file) << whole;
  CHECK(offered() == 1);
  fs::rename(file, home.path / "elsewhere");
  fs::create_symlink(home.path / "elsewhere", file);
  CHECK(offered() == 0);
  // A folder that others may look into, and none at all.
  fs::permissions(home.path / "nacre", fs::perms(0755));
  CHECK(EditsFile::Open("a.json", &why_not) == nullptr);
  CHECK(why_not.find("XDG_STATE_HOME") != std::string::npos);
}

}  // namespace
}  // namespace nacre
