#include "runners/presentation/export_formats.h"

#include <gtest/gtest.h>

#include "analysis/storage/result_file.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::exported_run_test {
namespace {

constexpr const char* kThreePoints = R"({
  "scenario": {"name": "points", "points": [[0, 0, 0], [0.01, 0, 0], [0, 0, 0.5]]},
  "renderer": {"name": "proxy"},
  "trajectory": {"name": "waypoints", "waypoints": [[0, 0.02, 0, 0], [0, -0.01, 0, 0.1]]},
  "duration_s": 0.05, "frame_latency_s": 0.0105})";

class ExportedRunTest : public testing::Test {
 protected:
  std::filesystem::path store(const std::string& command, std::vector<Column> columns) {
    const Experiment experiment = Experiment::from_json(kThreePoints, "a test");
    if (columns.empty()) {
      SimulationOptions options;
      options.hash_frames = true;
      columns = (trace_ = simulate(experiment, options)).columns();
    }
    write_trace(folder_ / "a.h5", columns, provenance(experiment.to_json(), command, ""), {});
    return folder_ / "a.h5";
  }
  std::string export_as(const char* name, const std::filesystem::path& file,
                        const std::atomic<bool>* stop = nullptr) {
    const Hdf5Reader result(file);
    return refusal([&] {
      NewFiles files;
      export_result(export_format(name), {result, folder_ / name, files, {}, &scenes::kernels(), stop});
      files.finish();
    });
  }
  TestFolder folder_{"exported_run"};
  Trace trace_;
};

// The points are those of the configuration, from the first tick after the frame arrives at 10.5 ms.
TEST_F(ExportedRunTest, FramesAreThoseOfTheRun) {
  const Hdf5Reader result(store("remote-touch run a.json", {}));
  NewFiles files;
  const ExportJob job{result, folder_ / "x.vtp", files, {}, &scenes::kernels(), nullptr};
  const ExportedRun run = exported_run(job);
  EXPECT_EQ(run.time_s, trace_.time_s);
  EXPECT_EQ(run.hip_W[7], trace_.hip_position_m[7]);
  EXPECT_EQ(run.tool, nullptr);
  std::vector<ExportedFrame> frames;
  for_each_frame(job, run, [&](const ExportedFrame& frame) { frames.push_back(frame); });
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].first_tick, 11u);
  EXPECT_EQ(frames[0].captured_s, 0);
  EXPECT_EQ(frames[0].arrives_s, 0.0105);
  EXPECT_EQ(frames[0].points.x, (std::vector<double>{0, 0.01, 0}));
  EXPECT_EQ(frames[0].points.z, (std::vector<double>{0, 0, 0.5}));
}

TEST_F(ExportedRunTest, OtherFramesAreRefused) {
  store("remote-touch run a.json", {});
  std::vector<Column> columns = trace_.columns();
  for (Column& column : columns)
    if (column.name == "frame_hash") std::get<std::vector<std::uint64_t>>(column.values)[11] += 1;
  const auto file = store("remote-touch run a.json", columns);
  EXPECT_HAS(export_as("x.mcap", file), "has other frames than this program makes");
  EXPECT_HAS(export_as("x.vtp", file), "has other frames than this program makes");
  EXPECT_EQ(export_as("x.csv", file), "no InputError");
  EXPECT_EQ(files_in(folder_.path()), (std::vector<std::string>{"a.h5", "x.csv", "x_columns.csv"}));
}

TEST_F(ExportedRunTest, OddColumnsAreRefused) {
  store("remote-touch run a.json", {});
  const auto with = [&](const char* name, auto change) {
    std::vector<Column> columns = trace_.columns();
    for (Column& column : columns)
      if (column.name == name) change(column);
    return store("remote-touch run a.json", columns);
  };
  const auto negative = with("time", [](Column& c) { std::get<std::vector<double>>(c.values)[3] = -1; });
  EXPECT_HAS(export_as("x.mcap", negative),
             "/trace/time has a time that is not a number, negative, or 2e9 s or more");
  const auto back =
      with("frame_index", [](Column& c) { std::get<std::vector<std::int32_t>>(c.values)[3] = 9; });
  EXPECT_HAS(export_as("x.vtp", back), "/trace/frame_index goes back");
  const auto narrow = with("force", [](Column& c) { c.width = 1; });
  EXPECT_HAS(export_as("x.mcap", narrow), "/trace/force has values of another type or width");
  const auto cut = with("hip_position", [](Column& c) { std::get<std::vector<double>>(c.values).resize(3); });
  EXPECT_HAS(export_as("x.vtp", cut), "hip_position is not as long as /trace/time");
  EXPECT_HAS(export_as("x.vtp", store("remote-touch live a.json", {})), "is of a live run");
  EXPECT_EQ(files_in(folder_.path()), std::vector<std::string>{"a.h5"});
}

// A run without a tool has no torque.
TEST_F(ExportedRunTest, AMissingColumnIsRefused) {
  store("remote-touch run a.json", {});
  for (const std::string missing : {"hip_position", "proxy_position", "force"}) {
    std::vector<Column> columns = trace_.columns();
    std::erase_if(columns, [&](const Column& column) { return column.name == missing; });
    const auto file = store("remote-touch run a.json", columns);
    EXPECT_HAS(export_as("x.mcap", file), "damaged (it has no /trace/" + missing + ")");
  }
  EXPECT_EQ(files_in(folder_.path()), std::vector<std::string>{"a.h5"});
}

TEST_F(ExportedRunTest, AnInterruptedExportLeavesNothing) {
  const auto file = store("remote-touch run a.json", {});
  const std::atomic<bool> stop = true;
  for (const char* name : {"x.csv", "x.npz", "x.vtp", "x.mcap"})
    EXPECT_THROW(export_as(name, file, &stop), Interrupted) << name;
  EXPECT_EQ(files_in(folder_.path()), std::vector<std::string>{"a.h5"});
}

TEST(ExportFormat, IsChosenByTheEnding) {
  for (const ExportFormat& format : export_formats())
    EXPECT_EQ(export_format(std::string("folder.d/x") + format.ending).ending, format.ending);
  EXPECT_HAS(refusal([] { export_format("x.txt"); }),
             "x.txt: has an unknown ending: expected one of .csv, .npz, .vtp");
}

}  // namespace
}  // namespace remote_touch::exported_run_test
