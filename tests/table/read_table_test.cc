// SPDX-License-Identifier: Apache-2.0
// Tables of other programs, and of strangers.
#include "table/read_table.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "catch.h"
#include "table/materials.h"
#include "table/npy.h"

namespace nacre {
namespace {

const std::vector<std::string> kColumns = {"light_x", "light_y", "light_z", "view_x", "view_y",
                                           "view_z",  "f_r",     "f_g",     "f_b"};

EvaluatedTable Evaluated(const BrdfTable& table) {
  return EvaluatedOf(table, "t", kColumns, {"diffuse", "specular"});
}

// What reading the file says.
std::string Refusal(const std::string& path) {
  try {
    Evaluated(ReadTable(path));
  } catch (const Error& error) {
    CHECK(error.code() == ExitCode::kBadInput);
    return error.what();
  }
  return "";
}

std::string Npy(const std::string& header, const std::string& data, char version = 1) {
  std::string bytes = std::string("\x93NUMPY") + version + '\0';
  const size_t size = header.size();
  for (int i = 0; i < (version == 1 ? 2 : 4); ++i) bytes += static_cast<char>(size >> 8 * i & 0xff);
  return bytes + header + data;
}

template <class Number>
std::string Bytes(const std::vector<Number>& numbers) {
  std::string bytes(numbers.size() * sizeof(Number), '\0');
  if (!numbers.empty()) std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

}  // namespace

TEST_CASE("columns are found by obvious names in any order and between any separators") {
  const TemporaryFolder folder;
  const std::string texts[] = {
      "light_x,light_y,light_z,view_x,view_y,view_z,f_r,f_g,f_b\n0,0,1,.6,0,.8,1,2,3\n",
      "# a comment\n\n\"L.x\";\"L.y\";\"L.z\";V.x;V.y;V.z;R;G;B\r\n0;0;1;0.6;0;0.8;1;2;3\r\n",
      "\xef\xbb\xbfview_0\tview_1\tview_2\tto_light_x\tto_light_y\tto_light_z\tf0\tf1\tf2\n"
      "0.6\t0\t0.8\t0\t0\t1\t1\t2\t3",
      "lightX lightY lightZ viewX viewY viewZ red green blue\n 0 0 1 6e-1 0 8e-1 1 2 3\n",
      "0,0,1,.6,0,.8,1,2,3\n",
      "pdf,viewdir_x,viewdir_y,viewdir_z,lx,ly,lz,brdf_r,brdf_g,brdf_b\n7,.6,0,.8,0,0,1,1,2,3\n"};
  for (const std::string& text : texts) {
    CAPTURE(text);
    const EvaluatedTable table = Evaluated(ReadTable(folder.Write("t.csv", text)));
    REQUIRE(table.pairs.size() == 1);
    CHECK(table.pairs[0].to_light == Vec3d(0, 0, 1));
    CHECK(table.pairs[0].to_view == Vec3d(0.6, 0, 0.8));
    CHECK(table.f[0] == Rgb(1, 2, 3));
    CHECK(table.pdf.has_value() == (text.find("pdf") == 0));
  }
}

TEST_CASE("JSON may be rows, arrays by name or records, with NaN") {
  const TemporaryFolder folder;
  const std::string texts[] = {
      R"({"columns": ["light_x","light_y","light_z","view_x","view_y","view_z","f_r","f_g","f_b"],
          "rows": [[0,0,1,0.6,0,0.8,1,2,3]]})",
      R"({"light": [[0,0,1]], "view": [[0.6,0,0.8]], "f": [[1,2,3]], "by": "us"})",
      R"([{"light": [0,0,1], "view": [0.6,0,0.8], "f": [1,2,3]}])"};
  for (const std::string& text : texts) {
    CAPTURE(text);
    const EvaluatedTable table = Evaluated(ReadTable(folder.Write("t.json", text)));
    CHECK(table.pairs[0].to_view == Vec3d(0.6, 0, 0.8));
    CHECK(table.f[0] == Rgb(1, 2, 3));
  }
  const EvaluatedTable nan = Evaluated(ReadTable(folder.Write(
      "n.json", R"({"light": [[0,0,1]], "view": [[0,0,1]], "f": [[NaN, -Infinity, null]]})")));
  for (int c = 0; c < 3; ++c) CHECK(std::isnan(nan.f[0][c]));
}

TEST_CASE("NPY files have named columns or two axes, of any number type") {
  const TemporaryFolder folder;
  const std::vector<double> row = {0, 0, 1, 0.6, 0, 0.8, 1, 2, 3};
  const std::vector<float> floats(row.begin(), row.end());
  const std::string plain =
      Npy("{'descr': '<f8', 'fortran_order': False, 'shape': (1, 9), }\n", Bytes(row));
  const std::string vectors =
      Npy("{'descr': [('light', '<f4', (3,)), ('view', '<f4', (3,)), ('f', '<f4', (3,))], "
          "'fortran_order': False, 'shape': (1,), }\n",
          Bytes(floats), 3);
  std::string big = Bytes(row);
  for (auto at = big.begin(); at != big.end(); at += 8) std::reverse(at, at + 8);
  const std::string big_endian =
      Npy("{'descr': '>f8', 'fortran_order': True, 'shape': (1, 9), }\n", big);
  for (const std::string& bytes : {plain, vectors, big_endian, NpyBytes(kColumns, row)}) {
    const EvaluatedTable table = Evaluated(ReadTable(folder.Write("t.npy", bytes)));
    CHECK(table.pairs[0].to_light == Vec3d(0, 0, 1));
    CHECK((table.pairs[0].to_view - Vec3d(0.6, 0, 0.8)).length() < 1e-7);
    CHECK(table.f[0] == Rgb(1, 2, 3));
  }
}

TEST_CASE("what is no table is told in one line, with its place") {
  const TemporaryFolder folder;
  const std::string head = "light_x,light_y,light_z,view_x,view_y,view_z,f_r,f_g,f_b\n";
  const std::string good = "0,0,1,0,0,1,1,1,1\n";
  const struct {
    const char* name;
    std::string bytes;
    const char* says;
  } cases[] = {
      {"a.csv", "", "is empty"},
      {"a.csv", "# only comments\n", "has no columns"},
      {"a.csv", head, "has no rows"},
      {"a.csv", head + good + "0,0,1,0,0,1,1,1\n", "line 3 has 8 values"},
      {"a.csv", head + good + "0,0,1,0,0,x,1,1,1\n", "line 3: \"x\" is not a number"},
      {"a.csv", head + "0,0,1e999,0,0,1,1,1,1\n", "line 2: \"1e999\" is not a number"},
      {"a.csv", head + good + "0,0,2,0,0,1,1,1,1\n", "line 3: light (0, 0, 2) has length 2"},
      {"a.csv", head + "0,0,1,0,nan,1,1,1,1\n", "line 2: view (0, nan, 1) is not finite"},
      {"a.csv", head + "1e200,0,1,0,0,1,1,1,1\n", "is not finite, or far too long"},
      {"a.csv", "light_x,light_y,light_z,f_r,f_g,f_b\n0,0,1,1,1,1\n", "has no columns view_x"},
      {"a.csv", "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,f\n0,0,1,0,0,1,1\n", "wi and wo are light and view"},
      {"a.csv", "light_x,light_y,light_z,view_x,view_y,view_z,g\n0,0,1,0,0,1,1\n",
       "has no columns f_r"},
      {"a.csv", "light_x,light.x,light_z,view_x,view_y,view_z,f\n0,0,1,0,0,1,1\n",
       "has two columns"},
      {"a.csv", "1,2,3,4\n", "4 columns without names"},
      {"a.csv", "light_x\0,", "has no columns"},
      {"a.json", "{", "not JSON"},
      {"a.json", "7", "is no table"},
      {"a.json", "{\"a\": 7}", "has no lists"},
      {"a.json", R"({"columns": ["a"], "rows": [[1, 2]]})", "/rows/0: is not a list of 1"},
      {"a.json", R"({"columns": ["a"], "rows": [["x"]]})", "/rows/0/0: is not a number"},
      {"a.json", R"({"light": [[0,0,1]], "f": [1, 2]})", "has 2 elements"},
      {"a.json", R"({"light": [[0,0,1],[0,0]], "f": [1, 2]})", "another number of elements"},
      {"a.npy", "not an array at all", "is not a NumPy file"},
      {"a.npy", "PK\3\4..........", "is an .npz archive"},
      {"a.npy", Npy("{'descr': '|O', 'fortran_order': False, 'shape': (1, 9), }\n", "x"),
       "holds pickled objects"},
      {"a.npy", Npy("{'descr': '<U5', 'fortran_order': False, 'shape': (1, 9), }\n", "x"),
       "not numbers"},
      {"a.npy", Npy("{'descr': '<f8', 'fortran_order': False, 'shape': (1, 9), }\n", "x"),
       "has 1 bytes of numbers, but its header tells 72"},
      {"a.npy",
       Npy("{'descr': '<f8', 'fortran_order': False, 'shape': (9999999999999, 9), }\n", "x"),
       "has 9999999999999 rows"},
      {"a.npy",
       Npy("{'descr': '<f8', 'fortran_order': False, 'shape': (1, 18446744073709551615), }\n", "x"),
       "columns"},
      {"a.npy",
       Npy("{'descr': '<f8', 'fortran_order': False, 'shape': (9,), }\n", Bytes<double>({})),
       "has 1 axes"},
      {"a.npy", Npy("__import__('os').system('id')\n", ""), "has a header that is none"},
      {"a.npy", Npy("{'descr': '<f8'", ""), "has a header that is none"},
      {"a.npy", std::string("\x93NUMPY\1\0\xff\xff{}", 12), "ends in its header"},
  };
  for (const auto& [name, bytes, says] : cases) {
    const std::string refusal = Refusal(folder.Write(name, bytes));
    CAPTURE(bytes, refusal);
    CHECK(refusal.find(says) != std::string::npos);
    CHECK(refusal.size() < 8000);
  }
  CHECK(Refusal(folder.Path("missing.csv")).find("missing.csv") != std::string::npos);
}

TEST_CASE("many bad rows are counted, not listed") {
  const TemporaryFolder folder;
  std::string text = "light_x,light_y,light_z,view_x,view_y,view_z,f\n";
  for (int i = 0; i < 1000; ++i) text += "0,0,2,0,0,3,1\n";
  const std::string refusal = Refusal(folder.Write("a.csv", text));
  CHECK(refusal.find("line 2: light") != std::string::npos);
  CHECK(refusal.size() < 8000);
}

TEST_CASE("directions of few digits are normalised and told, and exact ones are kept") {
  const TemporaryFolder folder;
  const EvaluatedTable table = Evaluated(ReadTable(folder.Write(
      "a.csv", "light_x,light_y,light_z,view_x,view_y,view_z,f\n0.70711,0,0.70711,0,0,1,1\n")));
  CHECK(std::abs(table.pairs[0].to_light.length() - 1) < 1e-15);
  REQUIRE(table.notes.size() == 1);
  CHECK(table.notes[0].find("rounded") != std::string::npos);
}

TEST_CASE("columns that nobody needs are left out and named, lobes and a grey f are taken") {
  const TemporaryFolder folder;
  const EvaluatedTable table = Evaluated(ReadTable(
      folder.Write("a.csv",
                   "light_x,light_y,light_z,view_x,view_y,view_z,f,sample,specular,albedo\n"
                   "0,0,1,0,0,1,inf,7,0.5,1\n")));
  CHECK(std::isinf(table.f[0].x));
  CHECK(table.lobes.at("specular")[0] == Rgb(0.5));
  CHECK((*table.albedo)[0] == Rgb(1));
  REQUIRE(table.notes.size() == 1);
  CHECK(table.notes[0] == "left out: sample");
}

}  // namespace nacre
