// Traces and figures of schema /2 are read; old names of a figure's columns become present ones.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "analysis/comparison/column_source.h"
#include "analysis/storage/hdf5_file.h"
#include "analysis/trace/renamed_columns.h"
#include "tests/support/test_files.h"

namespace remote_touch::stored_columns_test {
namespace {

using Names = std::vector<std::string>;
using Numbers = std::vector<double>;

void write_figure_file(const std::filesystem::path& file, const std::string& schema) {
  Hdf5Writer hdf5;
  hdf5.attribute("/", "schema", schema);
  hdf5.group("/tables");
  hdf5.group("/tables/edge");
  hdf5.columns("/tables/edge",
               {{"voxels_all_lost", "m/s", "all are lost", Numbers{3, 4}},
                {"voxels_lost", "m/s", "one is lost", Numbers{1, 2}}},
               "");
  hdf5.save(file);
}

TEST(StoredColumns, OfAnEarlierFigureHavePresentNames) {
  const TestFolder folder("stored_columns_test");
  write_figure_file(folder / "old.h5", "remote-touch-figure/2");
  const StoredFigure old{Hdf5Reader(folder / "old.h5")};
  EXPECT_EQ(old.column_names(), (Names{"edge/voxels_all_lost", "edge/voxels_first_lost"}));
  const Column first_lost = old.column("edge/voxels_first_lost");
  EXPECT_EQ(first_lost.name, "voxels_first_lost");
  EXPECT_EQ(std::get<Numbers>(first_lost.values), (Numbers{1, 2}));
  EXPECT_EQ(std::get<Numbers>(old.rows("edge/voxels_first_lost", 1, 1).values), Numbers{2});
}

TEST(StoredColumns, OfAPresentFigureKeepTheirNames) {
  const TestFolder folder("stored_columns_test");
  write_figure_file(folder / "new.h5", "remote-touch-figure/3");
  EXPECT_EQ(StoredFigure{Hdf5Reader(folder / "new.h5")}.column_names(),
            (Names{"edge/voxels_all_lost", "edge/voxels_lost"}));
}

TEST(StoredColumns, OfAnEarlierTraceAreRead) {
  const TestFolder folder("stored_columns_test");
  Hdf5Writer hdf5;
  hdf5.attributes("/", {{"schema", "remote-touch-trace/2"}, {"columns", "time,right"}});
  hdf5.group("/trace");
  hdf5.columns(
      "/trace",
      {{"time", "s", "simulated time", Numbers{0, 0.001}}, {"right", "1", "a number", Numbers{5, 6}}}, "");
  hdf5.save(folder / "old.h5");
  const StoredTrace old(folder / "old.h5");
  EXPECT_EQ(old.column_names(), (Names{"time", "right"})) << "names of a trace have not changed";
  EXPECT_EQ(std::get<Numbers>(old.column("time").values), (Numbers{0, 0.001}));
}

TEST(PresentColumn, IsKnownForOldNamesOnly) {
  EXPECT_EQ(present_column("press/continuous_stray_torque"), "press/continuous_torque_error");
  EXPECT_EQ(present_column("shown"), "significant");
  EXPECT_EQ(present_column("regions/apart"), "regions/difference_in_standard_errors");
  EXPECT_EQ(present_column("red/right"), "red/found");
  for (const std::string name :
       {"", "/", "right/wrong", "upright", "edge/voxels_all_lost", "lost", "second_", "a/b"})
    EXPECT_EQ(present_column(name), name);
}

}  // namespace
}  // namespace remote_touch::stored_columns_test
