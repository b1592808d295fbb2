// Same configuration, same bits: for any instruction set and number of threads, whatever came before, and for
// any seed that is not used.
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "analysis/storage/digest.h"
#include "analysis/trace/columns.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/configuration.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/support/scenes.h"

namespace remote_touch::determinism_test {
namespace {

std::string digest_of(const std::string& name, const std::vector<std::string>& overrides, Isa isa) {
  SimulationOptions options;
  options.kernels = &kernels_for(isa);
  options.hash_frames = true;
  return digest(simulate(Experiment::load(name, overrides), options).columns());
}

struct Case {
  const char* experiment;
  std::vector<std::string> overrides;
};

// A quarter of the usual pixels, for long runs.
const std::string kWidth = "scenario.width=320", kHeight = "scenario.height=240",
                  kFocal = "scenario.focal_px=262.5";
const Case kCases[] = {
    {"fig4.11", {"duration_s=2"}},
    {"fig4.12", {}},
    {"fig4.12", {"scenario.noise_sigma_m=0.01", "seed=11"}},
    {"fig4.14", {"duration_s=1"}},
    {"fig4.16", {"duration_s=0.5"}},
    {"fig6.3", {}},
    {"fig6.3", {"renderer.contact_rule=voxels"}},
    {"fig4.16",
     {"duration_s=0.2", "depth_pipeline.sigma_f_m=0.01", "renderer.name=tool",
      "renderer.tool_voxel_m=0.002"}},
    {"fig7.5", {"duration_s=2.4", "scenario.frame_rate_hz=5", kWidth, kHeight, kFocal}},
    {"valve-sequence", {"duration_s=0.6", "scenario.frame_rate_hz=5", kWidth, kHeight, kFocal}},
    {"rocking-plane", {"duration_s=1", "scenario.shape=ripple"}},
    {"sliding-ridge", {"duration_s=1", "scenario.shape=sphere", "scenario.tilt_deg=9"}},
    {"faulty-lift", {"faults.rolling_shutter_s=0.01", "scenario.truth=moving"}}};

TEST(Determinism, EveryInstructionSetAndNumberOfThreadsGivesTheSameBits) {
  struct Other {
    Isa isa;
    int threads;
  };
  const int threads_before = omp_get_max_threads();
  for (const Case& c : kCases) {
    omp_set_num_threads(1);
    const std::string reference = digest_of(c.experiment, c.overrides, Isa::x86_64);
    for (const auto& [isa, threads] : {Other{Isa::x86_64_v3, 2}, Other{Isa::x86_64_v4, 8}}) {
      omp_set_num_threads(threads);
      // The digests_across_builds test names the available levels in the build's summary.
      const Isa used = std::min(isa, best_isa());
      EXPECT_EQ(digest_of(c.experiment, c.overrides, used), reference)
          << c.experiment << ", " << kernels_for(used).isa << ", " << threads << " threads";
    }
  }
  omp_set_num_threads(threads_before);
}

// The kept list of neighbours must have no effect: a renderer that was elsewhere before ends in the same
// position.
TEST(Determinism, TheHistoryOfTheNeighbourListChangesNoBits) {
  PointCloud cloud = scenes::flat_grid(60);
  const PointCloud bumps = scenes::random_cloud(static_cast<int>(cloud.size()), 0.002, 3);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.x[i] += bumps.x[i], cloud.y[i] += bumps.y[i], cloud.z[i] += bumps.z[i];
  const auto points = std::make_shared<UniformGridSearch>(cloud, 0.004);
  const auto settle = [&](const Vec3& detour) {
    ProxyRenderer renderer = scenes::renderer();
    renderer.on_frame({0, 0, 0, points});
    renderer.step({Vec3(0, 0.03, 0)}, 0);
    renderer.step({detour}, 0.001);
    renderer.step({Vec3(0, 0.03, 0)}, 0.002);
    RenderOutput out;
    for (int tick = 3; tick < 20; ++tick) out = renderer.step({Vec3(0, -0.01, 0)}, 0.001 * tick);
    return out;
  };
  const RenderOutput a = settle(Vec3(0.002, 0.03, 0)), b = settle(Vec3(0.031, 0.028, -0.02));
  EXPECT_EQ(a.proxy_W, b.proxy_W);
  EXPECT_EQ(a.force_N, b.force_N);
}

// An experiment of two frames in which one parameter of a section has a value of its own.
Json with_setting(const ExperimentSection& section, const SectionEntry& entry, const std::string& parameter,
                  double value) {
  Json json = Json::parse(R"({"scenario": {"name": "moving-lift", "noise_sigma_m": 0},
      "renderer": {"name": "proxy"}, "slave": {"natural_frequency_hz": 5},
      "trajectory": {"name": "waypoints", "waypoints": [[0, 0.002, 0, 0], [0, -0.002, 0, 0.1]]}})");
  Json& part = section.is_top_level ? json : json[section.key];
  if (!entry.name.empty()) part = {{"name", entry.name}};
  for (const Parameter& other : entry.make()->settings())
    if (other.name == "tool_voxel_m") part[other.name] = 0.002;  // a fine tool takes seconds to make
  part[parameter] = value;
  json["duration_s"] = 0.035;
  return json;
}

enum class Draws { nothing, random_numbers, refused };

// Compares the run with another seed, unless it draws random numbers. A part is refused, for example, because
// it needs a file.
Draws compare_seeds(Json json) try {
  const auto digest_with = [&](std::uint64_t seed) {
    json["seed"] = seed;
    SimulationOptions options;
    options.hash_frames = true;
    return digest(simulate(Experiment::from_json(json), options).columns());
  };
  if (!random_streams(Experiment::from_json(json)).is_fixed()) return Draws::random_numbers;
  EXPECT_EQ(digest_with(1), digest_with(2)) << json.dump();
  return Draws::nothing;
} catch (const InputError&) {
  return Draws::refused;
}

// Runs that differ would count as equal if random_streams() left out a parameter.
TEST(Determinism, RunsThatDrawNothingIgnoreTheSeed) {
  std::map<Draws, int> counts;
  for (const ExperimentSection& section : experiment_sections())
    for (const SectionEntry& entry : section.entries())
      for (const Parameter& parameter : entry.make()->settings()) {
        if (!std::holds_alternative<double*>(parameter.value) || parameter.name == "duration_s") continue;
        const double value = std::clamp(0.4, parameter.low, parameter.high);
        ++counts[compare_seeds(with_setting(section, entry, parameter.name, value))];
      }
  EXPECT_GT(counts[Draws::nothing], 100);
  EXPECT_GT(counts[Draws::random_numbers], 20);
}

}  // namespace
}  // namespace remote_touch::determinism_test
