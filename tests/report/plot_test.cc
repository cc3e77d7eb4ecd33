// SPDX-License-Identifier: Apache-2.0
// Diagrams: what goes to gnuplot and to CSV, and that files appear whole or not at all.
#include "report/plot.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/error.h"
#include "catch.h"
#include "report/child_process.h"
#include "report/gnuplot.h"
#include "report/layout.h"

namespace nacre {
namespace {

namespace fs = std::filesystem;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A folder for one test, removed at its end.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "nacre_plot_XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path_ = name;
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string operator/(const char* name) const { return (path_ / name).string(); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string Content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Plot Line(double from, double to) {
  Plot plot;
  plot.x.label = "x (m)";
  plot.y.label = "y (s)";
  plot.curves.push_back({"a line", {0, 1, 2}, {from, (from + to) / 2, to}});
  return plot;
}

// Value of big-endian bytes.
uint32_t BigEndian(const std::string& bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = at; i < at + 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes.at(i));
  return value;
}

}  // namespace

TEST_CASE("a field is drawn as colours within its scale, and has all of its numbers as CSV") {
  Plot plot;
  plot.x = {.label = "x (m)", .low = 0, .high = 2};
  plot.y = {.label = "y (s)", .low = 0, .high = 2};
  plot.field = Field{"f (1/sr)", {0.5, 1.5, 0.5, 1.5}, {0.5, 0.5, 1.5, 1.5}, {0, 0.01, 5, kNan}};
  plot.field->low = 1e-3;
  const Figure figure = MakeFigure(plot);
  CHECK(FigureCsv(figure) ==
        "x (m),y (s),f (1/sr)\n0.5,0.5,0\n1.5,0.5,0.01\n0.5,1.5,5\n1.5,1.5,\n");
  const std::string script = GnuplotScript(figure, PictureFormat::kPng);
  // A logarithm has no 0: it has the colour of the scale's lower end, and 5 that of the upper one.
  for (const char* line : {"0.5 0.5 0.001\n", "1.5 0.5 0.01\n", "0.5 1.5 1\n", "1.5 1.5 NaN\n",
                           "set cbrange [0.001:1]", "'f (1/sr)'", "with image"}) {
    CHECK(script.find(line) != std::string::npos);
  }
}

TEST_CASE("names of CSV columns need no quotes and begin no comment") {
  CHECK(CsvText("F0 = 0.04, \"gold\"\r\n#1") == "F0 = 0.04; 'gold'  1");
}

TEST_CASE("CSV has each x once, and all digits") {
  Plot plot = Line(0.1, 1.0 / 3);
  plot.curves.push_back({"say \"b\", c", {0, 1, 2}, {1, kNan, 3}});
  plot.curves.push_back({"", {7}, {8}});
  CHECK(FigureCsv(MakeFigure(plot)) ==
        "x (m),a line,say 'b'; c,x (m),y (s)\n"
        "0,0.1,1,7,8\n"
        "1,0.21666666666666667,,,\n"
        "2,0.3333333333333333,3,,\n");
  plot.title = "left";
  plot.curves.resize(1);
  Plot right = Line(1, 2);
  right.title = "right";
  const std::string csv = FigureCsv(MakeRow({plot, right}));
  CHECK(csv.substr(0, csv.find('\n')) == "left: x (m),left: a line,right: x (m),right: a line");
}

TEST_CASE("Text cannot become a command of gnuplot") {
  CHECK(GnuplotQuote("it's\nme\x1b[m") == "'it’s\\nme\\u001b[m'");
  Plot plot = Line(0, 1);
  plot.title = "'; print 1/0; system 'false";
  plot.curves[0].title = "$HOME \\ `x` {/Bold y}_z";
  plot.rules.push_back({Rule::Across::kX, 1, "here'"});
  const Folder folder;
  WriteFigure(folder / "text.svg", MakeFigure(plot));
  const std::string svg = Content(folder / "text.svg");
  CHECK(svg.find("$HOME \\ `x` {/Bold y}_z") != std::string::npos);
  CHECK(svg.find("; print 1/0; system ") != std::string::npos);
}

TEST_CASE("Logarithms leave out what they cannot show") {
  Plot plot = Line(-1, 3);
  plot.y.log = true;
  const std::string script = GnuplotScript(MakeFigure(plot), PictureFormat::kSvg);
  CHECK(script.find("$p0c0 << EOD\n\n1 1\n2 3\nEOD\n") != std::string::npos);
  CHECK(RangeOf(plot, Which::kY).low == 1);
  CHECK(RangeOf(plot, Which::kY).high == Approx(5));  // out to the next tick
  plot.curves[0].y = {-1, kNan, 0};
  CHECK(RangeOf(plot, Which::kY).low > 0);
}

TEST_CASE("The key lies where no curve does") {
  const auto room = [](const Plot& plot) { return FindKeyRoom(plot, PlotLayout(plot, 1280, 800)); };
  // Rising: the upper left corner is free. Falling: the upper right one.
  REQUIRE(room(Line(0, 1)));
  CHECK(room(Line(0, 1))->x0 == 0);
  CHECK(room(Line(0, 1))->y1 == 1);
  CHECK(room(Line(1, 0))->x1 == 1);
  CHECK(room(Line(1, 0))->y1 == 1);
  // What else is there is kept free, too.
  PlotLayout layout(Line(0, 1), 1280, 800);
  layout.Occupy({0, 0.5, 0.5, 1});
  CHECK(FindKeyRoom(Line(0, 1), layout)->x1 == 1);
  CHECK(FindKeyRoom(Line(0, 1), layout)->y0 == 0);
  // Both at once: the corners are taken; there is room in between.
  Plot cross = Line(0, 1);
  cross.curves.push_back({"another", {0, 1, 2}, {1, 0.5, 0}});
  REQUIRE(room(cross));
  CHECK(PlotLayout(cross, 1280, 800).IsFree(*room(cross)));
  // A key as wide as the plot has none.
  Plot wide = Line(0, 1);
  wide.curves[0].title = std::string(200, 'x');
  CHECK(!room(wide));
}

TEST_CASE("Titles too wide for the key keep what tells them apart") {
  const std::string material =
      "metallic roughness, base color [0.3,0.1,0.1], roughness 0.6, coat 1, coat roughness 0.2, "
      "sheen color [0.4,0.5,1], sheen roughness 0.3";
  Plot plot = Line(0, 1);
  plot.curves.push_back(plot.curves[0]);
  const auto titles = [&](const std::string& a, const std::string& b) {
    plot.curves[0].title = a;
    plot.curves[1].title = b;
    return KeyTitles(plot, 1280);
  };
  using Titles = std::vector<std::string>;
  CHECK(titles("gold, viewer 30°", "gold, viewer 75°") ==
        Titles{"gold, viewer 30°", "gold, viewer 75°"});
  CHECK(titles(material + ", viewer 30°", material + ", viewer 30°, SIMD kernel") ==
        Titles{"metallic roughness, …", "metallic roughness, …, SIMD kernel"});
  CHECK(titles(material + ", viewer 30°", material + ", viewer 75°") ==
        Titles{"metallic roughness, …, viewer 30°", "metallic roughness, …, viewer 75°"});
  // A parameter in the middle.
  CHECK(titles(material + ", a 1, b 2", material + ", a 2, b 2") ==
        Titles{"metallic roughness, …, a 1, …", "metallic roughness, …, a 2, …"});
  // Nothing is shared: the middle goes, and no letter is halved.
  const Titles cut = titles(std::string(300, 'W') + "äöü 1", "short, one");
  CHECK(cut[0].substr(0, 2) == "WW");
  CHECK(cut[0].find("W…W") != std::string::npos);
  CHECK(cut[0].substr(cut[0].size() - 8) == "äöü 1");
  CHECK(cut[0].size() < 60);
  CHECK(cut[1] == "short, one");
  std::string umlauts;
  for (int i = 0; i < 400; ++i) umlauts += "ä";
  std::string left = titles(umlauts, "")[0];
  left.erase(left.find("…"), std::string("…").size());
  CHECK(left == umlauts.substr(0, left.size()));
  CHECK(left.size() % 2 == 0);
  // The script has them; CSV keeps whole titles.
  titles(material + ", viewer 30°", material + ", viewer 75°");
  const Figure figure = MakeFigure(plot);
  CHECK(GnuplotScript(figure, PictureFormat::kPng).find("'metallic roughness, …, viewer 30°'") !=
        std::string::npos);
  CHECK(FigureCsv(figure).find("sheen roughness 0.3; viewer 30°") != std::string::npos);
}

TEST_CASE("Words stand beside their lines") {
  const PlotLayout layout(Line(0, 1), 1280, 800);
  const PlotBox beside = RoomBesideColumn(layout, 0.5, 0.2);
  CHECK(layout.IsFree(beside));
  CHECK((beside.x0 > 0.5 || beside.x1 < 0.5));
  const PlotBox above = RoomAboveRow(layout, 0.5, 0.2);
  CHECK(layout.IsFree(above));
  CHECK(above.y0 >= 0.5);
  CHECK(above.y1 < 0.6);
}

TEST_CASE("Ticks stand at round numbers") {
  CHECK(NiceStep(0.9) == Approx(1));
  CHECK(NiceStep(1.1) == Approx(2));
  CHECK(NiceStep(0.021) == Approx(0.05));
  CHECK(NiceStep(600) == Approx(1000));
}

TEST_CASE("Figures are drawn in every form") {
  Plot plot = Line(0.001, 1000);
  plot.y.log = true;
  plot.rules.push_back({Rule::Across::kY, 1, "one"});
  Plot polar;
  polar.polar = true;
  polar.y.label = "f (1/sr)";
  polar.curves.push_back({"lobe", {-30, 0, 30}, {0.5, 1, 0.25}, CurveStyle::kMarkedLine});
  polar.rules.push_back({Rule::Across::kX, -45, "to light"});
  const Folder folder;
  for (const Figure& figure : {MakeFigure(plot), MakeFigure(polar), MakeRow({plot, polar})}) {
    WriteFigure(folder / "a.svg", figure);
    CHECK(Content(folder / "a.svg").find("</svg>") != std::string::npos);
    WriteFigure(folder / "a.png", figure);
    const std::string png = Content(folder / "a.png");
    REQUIRE(png.size() > 1000);
    CHECK(png.substr(1, 3) == "PNG");
    CHECK(BigEndian(png, 16) == static_cast<uint32_t>(figure.width));
    CHECK(BigEndian(png, 20) == static_cast<uint32_t>(figure.height));
    WriteFigure(folder / "a.csv", figure);
    CHECK(Content(folder / "a.csv") == FigureCsv(figure));
  }
  // The same figure makes the same bytes.
  WriteFigure(folder / "b.png", MakeFigure(plot));
  WriteFigure(folder / "c.png", MakeFigure(plot));
  CHECK(Content(folder / "b.png") == Content(folder / "c.png"));
}

TEST_CASE("An unknown form or a missing gnuplot is told, and nothing is written") {
  const Folder folder;
  const Figure figure = MakeFigure(Line(0, 1));
  CHECK_THROWS_AS(WriteFigure(folder / "a.pdf", figure), Error);
  const std::string before = std::getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  try {
    WriteFigure(folder / "a.png", figure);
    FAIL_CHECK("drawn without gnuplot");
  } catch (const Error& error) {
    CHECK(error.code() == ExitCode::kCannotWrite);
    CHECK(std::string(error.what()).find("gnuplot-nox") != std::string::npos);
  }
  WriteFigure(folder / "a.csv", figure);  // needs none
  setenv("PATH", before.c_str(), 1);
  CHECK(!fs::exists(folder / "a.pdf"));
  CHECK(!fs::exists(folder / "a.png"));
  CHECK(fs::exists(folder / "a.csv"));
}

TEST_CASE("A program's streams are whole, and its end is told") {
  const std::string text(300000, 'x');  // more than a pipe holds
  const ChildResult cat = RunChild({"cat"}, text);
  CHECK(cat.status == 0);
  CHECK(cat.output == text);
  const ChildResult failed = RunChild({"ls", "/no such folder"}, "");
  CHECK(failed.found);
  CHECK(failed.status != 0);
  CHECK(failed.errors.find("/no such folder") != std::string::npos);
  CHECK(!RunChild({"no-such-program-here"}, "").found);
}

TEST_CASE("Programs are those of PATH's absolute folders, and told little") {
  std::string name = (fs::temp_directory_path() / "nacre_planted_XXXXXX").string();
  REQUIRE(mkdtemp(name.data()) != nullptr);
  const fs::path folder = name;
  std::ofstream(folder / "planted-program") << "#!/bin/sh\necho planted\n";
  fs::permissions(folder / "planted-program", fs::perms::owner_all);
  const std::string before = std::getenv("PATH");
  const fs::path here = fs::current_path();
  fs::current_path(folder);
  for (const std::string& relative :
       {std::string(), std::string("."), std::string("./"), "../" + folder.filename().string()}) {
    for (const std::string& path :
         {relative, relative + ":" + before, before + ":" + relative, before + "::" + relative}) {
      setenv("PATH", path.c_str(), 1);
      CHECK(!FindProgram("planted-program"));
      CHECK(!RunChild({"planted-program"}, "").found);
    }
  }
  setenv("PATH", (".:" + folder.string()).c_str(), 1);
  CHECK(RunChild({"planted-program"}, "").output == "planted\n");
  // Of the environment: nothing that names code or settings, and of lists what is absolute.
  setenv("PATH", (before + ":.:relative").c_str(), 1);
  setenv("GNUPLOT_LIB", "/somewhere", 1);
  setenv("XDG_CONFIG_HOME", "relative", 1);
  const std::string told = RunChild({"env"}, "").output;
  CHECK(RunChild({"pwd"}, "").output == "/\n");
  unsetenv("GNUPLOT_LIB");
  unsetenv("XDG_CONFIG_HOME");
  setenv("PATH", before.c_str(), 1);
  fs::current_path(here);
  fs::remove_all(folder);
  CHECK(told.find("GNUPLOT_LIB") == std::string::npos);
  CHECK(told.find("relative") == std::string::npos);
  CHECK(told.find("PATH=/") != std::string::npos);
}

}  // namespace nacre
