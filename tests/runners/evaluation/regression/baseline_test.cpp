// The outcome of a check for each stored baseline.
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <nlohmann/json.hpp>

#include "analysis/storage/digest.h"
#include "analysis/storage/result_file.h"
#include "analysis/sweeps/sweep_file.h"
#include "runners/evaluation/regression/baselines.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/sweep_run.h"
#include "tests/support/result_files.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::baseline_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using State = BaselineCheck::State;

// --- checks ---

const char* const kExperiment = R"({"title": "a short press", "scenario": {"name": "flat-grid"},
  "renderer": {"name": "proxy"},
  "trajectory": {"name": "waypoints", "waypoints": [[-0.01, 0.01, 0, 0], [0.01, -0.003, 0, 0.1]]},
  "duration_s": 0.25})";
const char* const kSweep = R"({"title": "a small map", "experiment": "fig4.12",
  "set": {"haptic_rate_hz": 900, "renderer.steps_per_tick": 1},
  "axes": [{"parameter": "scenario.noise_sigma_m", "values": [0, 0.003]},
           {"parameter": "scenario.acceleration_m_per_s2", "values": [0, 6]}],
  "measures": ["popped_through", "max_penetration"]})";

class CheckBaseline : public testing::Test {
 protected:
  CheckBaseline() { folder_.write("short.json", kExperiment), folder_.write("map.json", kSweep); }

  static std::string changed_config(const std::string& config,
                                    const std::function<void(ordered_json&)>& change) {
    ordered_json json = ordered_json::parse(config);
    change(json);
    return json.dump();
  }
  using ChangeConfig = std::function<void(ordered_json&)>;

  // Stores short.h5 as the program that made it would, and returns its entry.
  Baseline stored_run(
      const std::function<void(Trace&)>& change = [](Trace&) {}, const ChangeConfig& change_config = {}) {
    const Experiment experiment = Experiment::load((folder_ / "short.json").string());
    SimulationOptions options;
    options.hash_frames = true;
    Trace trace = simulate(experiment, options);
    change(trace);
    std::string config = experiment.to_json();
    if (change_config) config = changed_config(config, change_config);
    write_trace(folder_ / "short.h5", trace, {{"config", config}, {"git_commit", "abc"}, {"isa", "z80"}}, {});
    return entered({"short", "run", "short.json"});
  }
  Baseline stored_sweep(
      const std::function<void(SweepResult&)>& change = [](SweepResult&) {},
      const ChangeConfig& change_config = {}) {
    const Sweep sweep = Sweep::load((folder_ / "map.json").string());
    SweepResult result = run_sweep(sweep, {});
    change(result);
    std::string config = sweep.to_json();
    if (change_config) config = changed_config(config, change_config);
    write_sweep(folder_ / "map.h5", result, {{"config", config}, {"git_commit", "abc"}});
    return entered({"map", "sweep", "map.json"});
  }
  Baseline entered(Baseline baseline) const {
    baseline.sha256 = sha256_of_file(file_of(folder_.path(), baseline));
    return baseline;
  }

  BaselineCheck check(const Baseline& baseline) const {
    BaselineCheck result = check_baseline(folder_.path(), baseline, scenes::kernels(), nullptr);
    EXPECT_EQ(result.name, baseline.name);
    EXPECT_FALSE(contains(result.text, "\n")) << result.text;
    EXPECT_FALSE(result.text.empty());
    return result;
  }
  void expect_uncomparable(const Baseline& baseline, const std::string& subject,
                           const std::string& why) const {
    const BaselineCheck result = check(baseline);
    EXPECT_EQ(result.state, State::not_comparable) << result.text;
    EXPECT_HAS(result.text, subject);
    EXPECT_HAS(result.text, why);
    EXPECT_FALSE(result.comparison);
  }
  std::string place(const std::string& name) const { return (folder_ / name).string(); }

  const TestFolder folder_{"baseline_test"};
};

TEST_F(CheckBaseline, IsTheSameForEveryMaker) {
  const BaselineCheck result = check(stored_run());
  EXPECT_EQ(result.state, State::same);
  EXPECT_EQ(result.text, "18 columns, every number is the same");
  ASSERT_TRUE(result.comparison);
  EXPECT_EQ(result.comparison->baseline, "short (stored)");
  EXPECT_EQ(result.comparison->candidate, "this program");
  EXPECT_EQ(result.comparison->outcome, Outcome::same);
  EXPECT_TRUE(result.comparison->configuration.empty());
}

TEST_F(CheckBaseline, ReportsChangesThatNoToleranceCovers) {
  for (const auto& change : std::vector<std::function<void(Trace&)>>{
           [](Trace& trace) { trace.state[100] ^= 1; }, [](Trace& trace) { trace.frame_hash[0] ^= 1; },
           [](Trace& trace) { trace.nearest_distance_m[9] = std::nan(""); },
           [](Trace& trace) { trace.force_N[3].x() = INFINITY; }}) {
    Baseline baseline = stored_run(change);
    baseline.tolerances = {{"*", {1e99}}};
    EXPECT_EQ(check(baseline).state, State::changed);
  }
}

TEST_F(CheckBaseline, UnknownNamesAreNotComparable) {
  Baseline baseline = stored_run();
  baseline.subject = "moon";
  expect_uncomparable(baseline, "moon: cannot be read", "remote-touch list");
  baseline.subject = "short.json", baseline.overrides = {"renderer.moon=1"};
  expect_uncomparable(baseline, "renderer.moon: unknown", "did you mean");
  baseline.overrides = {}, baseline.tolerances = {{"moon", {1}}};
  expect_uncomparable(baseline, "tolerance of moon", "no such column");
}

// --- checks of configurations by other versions of the program ---

TEST_F(CheckBaseline, ReportsARemovedParameter) {
  const BaselineCheck result =
      check(stored_run([](Trace&) {}, [](auto& config) { config["renderer"]["moon_m"] = 3; }));
  EXPECT_EQ(result.state, State::changed);
  EXPECT_EQ(result.text,
            "the numbers are equal, but the experiment differs: renderer.moon_m 3 against absent");
}

TEST_F(CheckBaseline, ReportsANewParameter) {
  EXPECT_EQ(check(stored_run([](Trace&) {}, [](auto& config) { config["renderer"].erase("gamma"); })).state,
            State::same);
  EXPECT_EQ(check(stored_run([](Trace&) {}, [](auto& config) { config.erase("frame_latency_s"); })).state,
            State::same);
  // A parameter that the stored configuration lacks counts with its default, which is not the value that is
  // run now.
  ordered_json json = ordered_json::parse(kExperiment);
  json["seed"] = 7;
  folder_.write("short.json", json.dump());
  const BaselineCheck result = check(stored_run([](Trace&) {}, [](auto& config) { config.erase("seed"); }));
  EXPECT_EQ(result.state, State::changed);
  EXPECT_EQ(result.text, "the numbers are equal, but the experiment differs: seed 1 against 7");
}

TEST_F(CheckBaseline, RefusesAConfigurationThatCannotBeRead) {
  Baseline baseline = stored_run();
  const Trace trace = simulate(Experiment::load(place("short.json")));
  write_trace(folder_ / "short.h5", trace, {{"config", "{\"seed\":"}}, {});
  expect_uncomparable(entered(baseline), "configuration", "parse error");
  for (const char* config : {"", "[]", "null"}) {
    write_trace(folder_ / "short.h5", trace, {{"config", config}}, {});
    EXPECT_EQ(check(entered(baseline)).state, State::changed) << config;
  }
}

// --- checks of damaged files ---

// The manifest holds the hash of the damaged file itself.
TEST_F(CheckBaseline, RefusesAFileThatWasStoredDamaged) {
  for (const Baseline& baseline : {stored_run(), stored_sweep()}) {
    const std::string name = baseline.name + ".h5", bytes = bytes_of(folder_ / name);
    for (const std::size_t at :
         {std::size_t{0}, std::size_t{100}, std::size_t{520}, bytes.size() / 2, bytes.size() - 1}) {
      std::string flipped = bytes;
      flipped.at(at) = static_cast<char>(flipped.at(at) ^ 1);
      folder_.write(name, flipped);
      expect_uncomparable(entered(baseline), place(name), "");
    }
    for (const std::string& other : {bytes.substr(0, bytes.size() / 2), bytes.substr(0, bytes.size() - 1),
                                     bytes + "x", std::string(), std::string("a text\n")}) {
      folder_.write(name, other);
      expect_uncomparable(entered(baseline), place(name), "expected");
    }
  }
}

TEST_F(CheckBaseline, RefusesAnotherSchema) {
  const Baseline run = stored_run(), sweep = stored_sweep();
  fs::copy_file(folder_ / "short.h5", folder_ / "map.h5", fs::copy_options::overwrite_existing);
  expect_uncomparable(entered(sweep), place("map.h5"), "remote-touch-sweep/3");
  stored_sweep();
  fs::copy_file(folder_ / "map.h5", folder_ / "short.h5", fs::copy_options::overwrite_existing);
  expect_uncomparable(entered(run), place("short.h5"), "remote-touch-trace/3");

  for (const std::string other : {"remote-touch-trace/1", "remote-touch-trace/4"}) {
    Hdf5Writer hdf5;
    hdf5.attribute("/", "schema", other);
    hdf5.save(folder_ / "short.h5");
    expect_uncomparable(entered(run), place("short.h5"), "schema " + other);
  }
}

// --- checks of sweeps ---

TEST_F(CheckBaseline, ChecksSweepsToo) {
  EXPECT_EQ(check(stored_sweep()).state, State::same);
  Baseline baseline = stored_sweep(
      [](SweepResult& result) { std::get<std::vector<double>>(result.measures[1].values)[2] += 0x1p-20; });
  const BaselineCheck changed = check(baseline);
  EXPECT_EQ(changed.state, State::changed);
  EXPECT_HAS(changed.text, "1 of 4 runs");
  baseline.tolerances = {{"max_penetration", {0x1p-19}}};
  EXPECT_EQ(check(baseline).state, State::same);

  const auto same = [](SweepResult&) {};
  const BaselineCheck older =
      check(stored_sweep(same, [](auto& config) { config["experiment"]["renderer"].erase("gamma"); }));
  EXPECT_EQ(older.state, State::same) << older.text;
  const BaselineCheck other =
      check(stored_sweep(same, [](auto& config) { config["experiment"]["frame_latency_s"] = 0.5; }));
  EXPECT_EQ(other.state, State::changed);
  EXPECT_HAS(other.text, "the experiment differs: experiment.frame_latency_s 0.5 against 0.0");

  const Baseline axes = stored_sweep();
  folder_.write("map.json", changed_config(kSweep, [](auto& json) { json["axes"][1]["values"] = {0, 5}; }));
  const BaselineCheck incomparable = check(axes);
  EXPECT_EQ(incomparable.state, State::not_comparable);
  EXPECT_EQ(incomparable.text, "axis acceleration_m_per_s2: the values differ");
}

}  // namespace
}  // namespace remote_touch::baseline_test
