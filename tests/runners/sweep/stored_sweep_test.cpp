// Sweeps of schema /2 are read with the present names of their settings.
#include "runners/sweep/stored_sweep.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/sweeps/sweep_file.h"
#include "runners/sweep/sweep.h"
#include "runners/sweep/sweep_session.h"
#include "tests/support/test_files.h"

namespace remote_touch::stored_sweep_test {
namespace {

// The configuration of a sweep as version 0.2 stored it, over one axis.
std::string old_configuration(const std::string& axis) {
  return R"({"title": "old", "experiment": {"scenario": {"name": "plates", "true_motion": false},
    "renderer": {"name": "proxy", "contact_rule": "tangent_plane"}, "trajectory": {"name": "press"},
    "duration_s": 0.1}, "axes": [)" +
         axis + R"(], "replicates": 1, "measures": ["max_force"]})";
}

// A finished sweep of two runs over the axis.
SweepResult two_runs(Column axis) {
  SweepResult result;
  result.axes = {std::move(axis)};
  result.measures = {{"max_force", "N", "maximum force", {}}};
  result.start(false);
  result.state = {RunState::done, RunState::done};
  std::get<std::vector<double>>(result.measures[0].values) = {1, 2};
  return result;
}

void write_old(const std::filesystem::path& file, const SweepResult& result, const std::string& config) {
  Hdf5Writer hdf5;
  hdf5.attributes("/", {{"schema", "remote-touch-sweep/2"},
                        {"axes", result.axes[0].name},
                        {"measures", "max_force"},
                        {"config", config},
                        {"digest", digest(result)}});
  hdf5.group("/sweep");
  hdf5.columns(
      "/sweep",
      {result.axes[0], result.measures[0], state_column(result), {"error", "1", "reason", result.error}}, "");
  hdf5.save(file);
}

// Writes an old sweep over the contact rule of the proxy, and returns its configuration.
std::string write_contact_rules(const std::filesystem::path& file) {
  const std::string config =
      old_configuration(R"({"parameter": "renderer.contact_rule", "values": ["tangent_plane", "regions"]})");
  write_old(file,
            two_runs({"contact_rule",
                      "1",
                      "renderer.contact_rule",
                      std::vector<std::int32_t>{0, 1},
                      1,
                      {"tangent_plane", "regions"}}),
            config);
  return config;
}

TEST(StoredSweep, HasPresentNamesOfAxesAndValues) {
  const TestFolder folder("stored_sweep_test");
  const std::string config = write_contact_rules(folder / "old.h5");
  EXPECT_EQ(read_sweep(folder / "old.h5").result.axes[0].name, "contact_rule");
  const StoredSweep stored = read_stored_sweep(folder / "old.h5");
  const Column& axis = stored.result.axes.at(0);
  EXPECT_EQ(axis.name, "contact_motion");
  EXPECT_EQ(axis.long_name, "renderer.contact_motion");
  EXPECT_EQ(axis.value_names, (std::vector<std::string>{"tangent-plane", "regions"}));
  EXPECT_EQ(stored.result.measure("max_force"), (std::vector<double>{1, 2}));
  const Sweep sweep = Sweep::from_json(attribute(stored.attributes, "config"), "old.h5");
  EXPECT_NO_THROW(sweep.require_fits(stored.result, "old.h5"));
  EXPECT_HAS(refusal([&] { Sweep::from_json(config, "old.json"); }), "; it is now ");
}

TEST(StoredSweep, ASwitchThatIsNowAChoiceHasItsNames) {
  const TestFolder folder("stored_sweep_test");
  const std::string config =
      old_configuration(R"({"parameter": "scenario.true_motion", "values": [true, false]})");
  write_old(folder / "old.h5",
            two_runs({"true_motion",
                      "1",
                      "scenario.true_motion",
                      std::vector<std::int32_t>{0, 1},
                      1,
                      {"true", "false"}}),
            config);
  const StoredSweep stored = read_stored_sweep(folder / "old.h5");
  EXPECT_EQ(stored.result.axes.at(0).name, "truth");
  EXPECT_EQ(stored.result.axes.at(0).value_names, (std::vector<std::string>{"moving", "newest-frame"}));
}

// `merge` writes shards of schema /2 in this way.
TEST(StoredSweep, WhatIsWrittenOfItSaysThatItsNamesAreTranslated) {
  const TestFolder folder("stored_sweep_test");
  const std::string config = old_configuration(R"({"parameter": "seed", "values": [1, 2]})");
  write_old(folder / "old.h5", two_runs({"seed", "1", "seed", std::vector<double>{1, 2}, 1, {}}), config);
  EXPECT_EQ(attribute(read_sweep(folder / "old.h5").attributes, "translated_from"), "");
  const StoredSweep stored = read_stored_sweep(folder / "old.h5");
  EXPECT_EQ(stored.schema, schema_name("sweep"));
  write_sweep(folder / "new.h5", stored.result, stored.attributes);
  const StoredSweep again = read_stored_sweep(folder / "new.h5");
  EXPECT_EQ(again.schema, schema_name("sweep"));
  EXPECT_EQ(again.attributes, stored.attributes);
  EXPECT_EQ(attribute(again.attributes, "translated_from"), "remote-touch-sweep/2");
}

TEST(StoredSweep, IsNotContinued) {
  const TestFolder folder("stored_sweep_test");
  write_contact_rules(folder / "old.h5");
  const Sweep sweep =
      Sweep::from_json(attribute(read_stored_sweep(folder / "old.h5").attributes, "config"), "new.json");
  EXPECT_HAS(refusal([&] {
               plan_in_file(sweep, {}, {{"config", sweep.to_json()}}, folder / "old.h5");
             }),
             "old.h5: was written with the earlier schema remote-touch-sweep/2: expected a new file");
}

TEST(StoredSweep, OtherAxesAreUnchanged) {
  const TestFolder folder("stored_sweep_test");
  const std::string config =
      old_configuration(R"({"parameter": "renderer.stiffness_N_per_m", "values": [300, 600]})");
  write_old(
      folder / "old.h5",
      two_runs({"stiffness_N_per_m", "N/m", "renderer.stiffness_N_per_m", std::vector<double>{300, 600}}),
      config);
  const Column axis = read_stored_sweep(folder / "old.h5").result.axes.at(0);
  EXPECT_EQ(axis.name, "stiffness_N_per_m");
  EXPECT_EQ(std::get<std::vector<double>>(axis.values), (std::vector<double>{300, 600}));
}

}  // namespace
}  // namespace remote_touch::stored_sweep_test
