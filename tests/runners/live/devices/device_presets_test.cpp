// The presets of data/devices: experiments with the limits of a haptic device.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "analysis/trace/trace.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/live/devices/haptic_device.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::device_presets_test {
namespace {

const std::filesystem::path kRoot = REMOTE_TOUCH_SOURCE_DIR;

// The device's limits, as its page states them. half_width_m: of a box inside the workspace. No force: an
// input device.
struct Preset {
  const char* name;
  const char* page;
  Vec3 half_width_m;
  double max_force_N, max_stiffness_N_per_m;
};
const Preset kPresets[] = {
    {"falcon", "force_dimension", {0.051, 0.051, 0.051}, 8.9, 3000},
    {"inverse3", "haply", {0.23, 0.255, 0.115}, 4, 1000},
    {"omega", "force_dimension", {0.043, 0.043, 0.043}, 12, 5000},  // the cube in a ball of 75 mm radius
    {"spacemouse", "spacemouse", {0.15, 0.15, 0.15}, 0, 0},
    {"touch", "touch", {0.08, 0.06, 0.035}, 3.3, 400},
};

std::string file_of(const Preset& preset) {
  return std::string("data/devices/") + preset.name + ".json";
}

Experiment load(const Preset& preset, const std::vector<std::string>& overrides = {}) {
  return Experiment::load((kRoot / file_of(preset)).string(), overrides);
}

void expect_in_workspace(const Preset& preset, const DevicePlacement& placement, const Vec3& p_W) {
  const Vec3 p_D = placement.of_device({.position_W = p_W}).position_m;
  EXPECT_TRUE((p_D.cwiseAbs().array() <= preset.half_width_m.array()).all())
      << preset.name << ": " << p_D.transpose();
}

TEST(DevicePresets, AreOneFileForEachDeviceAndAPageNamesIt) {
  std::set<std::string> files, known;
  for (const auto& entry : std::filesystem::directory_iterator(kRoot / "data/devices"))
    files.insert("data/devices/" + entry.path().filename().string());
  for (const Preset& preset : kPresets) {
    known.insert(file_of(preset));
    std::ifstream page(kRoot / "runners/live/hardware" / (std::string(preset.page) + ".md"));
    const std::string text{std::istreambuf_iterator<char>(page), {}};
    EXPECT_NE(text.find(file_of(preset)), std::string::npos) << preset.name;
  }
  EXPECT_EQ(files, known);
}

TEST(DevicePresets, KeepTheHandInTheWorkspace) {
  for (const Preset& preset : kPresets) {
    const Experiment experiment = load(preset);
    const auto scenario = experiment.build_scenario(scenes::kernels());
    const auto hand = experiment.build_trajectory(*scenario);
    const DevicePlacement placement(experiment.live());
    for (int i = 0; i <= 100; ++i)
      expect_in_workspace(preset, placement,
                          hand->at(0.01 * i * experiment.settings().duration_s).position_W);
    EXPECT_LE(hand->duration_s(), experiment.settings().duration_s) << preset.name;
  }
}

// The hand of a run yields to the force, so it is not where the trajectory is. Fewer pixels make the run
// short.
TEST(DevicePresets, KeepTheHandOfARunInTheWorkspace) {
  for (const Preset& preset : kPresets) {
    const Experiment experiment =
        load(preset, {"scenario.width=160", "scenario.height=120", "scenario.focal_px=131"});
    const DevicePlacement placement(experiment.live());
    const Trace trace = simulate(experiment);
    double yields_m = 0;
    for (std::size_t i = 0; i < trace.length(); ++i) {
      expect_in_workspace(preset, placement, trace.hip_position_m[i]);
      yields_m = std::max(yields_m, (trace.hip_position_m[i] - trace.intended_position_m[i]).norm());
    }
    EXPECT_EQ(yields_m > 0.001, preset.max_force_N > 0) << preset.name << " yields by " << yields_m << " m";
  }
}

TEST(DevicePresets, AStiffnessThatIsNoneDoesNotSwitchTheScalingOff) {
  EXPECT_EQ(force_scale(2400, 1, 600), 0.25);
  EXPECT_EQ(force_scale(300, 2, 600), 1);
  EXPECT_EQ(force_scale(1e6, 1, 0), 1) << "the limit of the device is not known";
  for (const double none : {std::nan(""), -1.0, HUGE_VAL})
    for (const std::array<double, 3>& a :
         {std::array{none, 1.0, 600.0}, std::array{2400.0, none, 600.0}, std::array{2400.0, 1.0, none}})
      EXPECT_HAS(refusal([&] { force_scale(a[0], a[1], a[2]); }), "expected a finite number, 0 or more");
}

TEST(DevicePresets, AskForNoMoreThanTheDeviceCanExert) {
  for (const Preset& preset : kPresets) {
    const Experiment experiment = load(preset);
    const auto device = [&](const std::string& name) { return experiment.value_at_start("device." + name); };
    EXPECT_EQ(device("max_force_N").get<double>(), preset.max_force_N) << preset.name;
    for (const char* axis : {"x", "y", "z"}) {
      EXPECT_EQ(device(std::string("force_") + axis).get<bool>(), preset.max_force_N > 0) << preset.name;
      EXPECT_FALSE(device(std::string("torque_") + axis).get<bool>()) << preset.name;
    }
    if (preset.max_force_N == 0) continue;
    EXPECT_LE(experiment.safety().max_force_N, 0.9 * preset.max_force_N) << preset.name;
    EXPECT_LE(experiment.max_stiffness_N_per_m() * experiment.live().device_scale,
              preset.max_stiffness_N_per_m)
        << preset.name;
  }
}

}  // namespace
}  // namespace remote_touch::device_presets_test
