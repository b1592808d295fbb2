// Figure files hold the tables of a figure, bit for bit, and its panels.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "analysis/storage/digest.h"
#include "analysis/storage/result_file.h"
#include "tests/support/result_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::figure_file_test {
namespace {

struct FigureFile : testing::Test {
  const TestFolder folder{"figure_file_test"};
};

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Figure small_figure() {
  Table table{"heights", "heights of two things", {}};
  table.add("time", "s", "simulated time", {0, 1, 2});
  table.add("y", "m", "height", {0.1, kNan, -0.0});
  table.columns.push_back(
      {"state", "1", "state", std::vector<std::int32_t>{0, 1, 0}, 1, {"free", "contact"}});
  Figure figure{"9.9", "A title", "A caption.", {table, {"other", "of another length", {}}}, {}, {}};
  figure.tables[1].add("x", "m", "place", {4});
  figure.panels = {
      {"Left",
       "time (s)",
       "y (m)",
       true,
       {{"heights", "time", "y", CurveStyle::line, ""}},
       {},
       std::pair(-1.0, 2.0)},
      {"Right", "x", "x", false, {{"other", "x", "x", CurveStyle::circle, "ball", 0.005}}, {}, {}}};
  figure.panels[1].grid_position = std::pair(3.0, 7.0);
  figure.claims = {claim_at_most("9.9", "a claim", "-", 1, 2, "m")};
  return figure;
}

TEST_F(FigureFile, TablesSurvive) {
  const Figure figure = small_figure();
  const std::string sum = write_figure(folder / "fig9.9.h5", figure, kProvenance);
  const Hdf5Content content = read_hdf5(folder / "fig9.9.h5");
  EXPECT_EQ(sum, digest(figure.tables));
  EXPECT_EQ(attribute(content, "digest"), sum);
  EXPECT_EQ(attribute(content, "schema"), "remote-touch-figure/3");
  EXPECT_EQ(attribute(content, "figure"), "9.9");
  EXPECT_EQ(attribute(content, "title"), "A title");
  EXPECT_EQ(attribute(content, "caption"), "A caption.");
  EXPECT_EQ(attribute(content, "command"), "remote-touch run x --set seed=1");
  EXPECT_EQ(content.datasets.size(), 4u);
  for (const Table& table : figure.tables) {
    for (const Column& column : table.columns) {
      const Column* found = find(content, "/tables/" + table.name + "/" + column.name);
      ASSERT_NE(found, nullptr) << column.name;
      EXPECT_TRUE(same_bits(*found, column)) << column.name;
      EXPECT_EQ(found->units, column.units);
      EXPECT_EQ(found->value_names, column.value_names);
    }
  }
}

// read_hdf5 does not read panels (h5dump does), so the test only checks that every word of a panel is in the
// file.
TEST_F(FigureFile, PanelsAreStored) {
  write_figure(folder / "fig.h5", small_figure(), {});
  const std::string bytes = bytes_of(folder / "fig.h5");
  for (const char* word :
       {"panels", "Left", "Right", "time (s)", "y (m)", "equal_aspect", "x_range", "y_range", "place",
        "curve0", "heights", "other", "line", "circle", "ball", "radius"})
    EXPECT_HAS(bytes, word);
  EXPECT_HAS(bytes, raw(-1.0) + raw(2.0));  // y_range of the first panel
  EXPECT_HAS(bytes, raw(3.0) + raw(7.0));   // place of the second
  EXPECT_HAS(bytes, raw(0.005));            // radius of the ball
}

TEST_F(FigureFile, ScenesAreStored) {
  Figure figure = small_figure();
  ScenePart solid{ScenePart::Kind::solid, "corners", 0xE07B39};
  solid.triangles = "faces", solid.poses = "places", solid.pose_row = 5, solid.opacity = 0.375;
  solid.label = "a thing";
  ScenePart dust{ScenePart::Kind::points, "dust", 0, 0.0625};
  dust.coloured_by = "height";
  figure.panels[0].scene = Scene{{1, 2, 3}, {4, 5, 6}, {7, 8, 9},
                                 0.25,      0.625,     {solid, dust, {ScenePart::Kind::segments, "lines"}}};
  write_figure(folder / "fig.h5", figure, {});
  const std::string bytes = bytes_of(folder / "fig.h5");
  for (const char* word :
       {"scene", "eye", "target", "part2", "solid", "points", "segments", "corners", "faces", "places",
        "pose_row", "dust", "lines", "a thing", "proportion", "coloured_by", "height"})
    EXPECT_HAS(bytes, word);
  EXPECT_HAS(bytes, raw(1.0) + raw(2.0) + raw(3.0));  // position of the eye
  for (const double value : {0.25, 0.625, 0.375, 0.0625}) EXPECT_HAS(bytes, raw(value));
}

TEST_F(FigureFile, checks) {
  Figure figure = small_figure();
  for (const auto& [style, name] :
       {std::pair(CurveStyle::line, "line"), std::pair(CurveStyle::dots, "dots"),
        std::pair(CurveStyle::steps, "steps"), std::pair(CurveStyle::dashed, "dashed"),
        std::pair(CurveStyle::circle, "circle"), std::pair(CurveStyle::bars, "bars"),
        std::pair(CurveStyle::letters, "letters"), std::pair(CurveStyle::intervals, "intervals")}) {
    figure.panels = {{"P", "", "", false, {{"heights", "time", "y", style, ""}}, {}, {}}};
    write_figure(folder / "fig.h5", figure, {});
    EXPECT_HAS(bytes_of(folder / "fig.h5"), name);
  }
}

TEST_F(FigureFile, StoresAFigureThatHasNoTablesOrPanels) {
  write_figure(folder / "fig.h5", Figure{"9.9", "", "Not run: no recording", {}, {}, {}}, {});
  const Hdf5Content content = read_hdf5(folder / "fig.h5");
  EXPECT_TRUE(content.datasets.empty());
  EXPECT_EQ(attribute(content, "title"), "");
  EXPECT_EQ(attribute(content, "caption"), "Not run: no recording");
}

TEST_F(FigureFile, EqualContentIsEqualBytes) {
  write_figure(folder / "a.h5", small_figure(), kProvenance);
  write_figure(folder / "b.h5", small_figure(), kProvenance);
  EXPECT_EQ(bytes_of(folder / "a.h5"), bytes_of(folder / "b.h5"));
}

}  // namespace
}  // namespace remote_touch::figure_file_test
