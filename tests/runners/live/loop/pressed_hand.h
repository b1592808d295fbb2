// Shared by tests of whole live runs: a hand that presses on a table, on a simulated clock.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "runners/experiment/catalog/experiment.h"
#include "tests/doubles/vendor_devices.h"
#include "tests/runners/live/loop/simulated_run.h"

namespace remote_touch {

// A proxy over the table of `camera-scene`. A hand at rest commands the same force in every frame if there is
// no noise.
constexpr const char* kPress = R"({
  "scenario": {"name": "camera-scene", "width": 160, "height": 120, "noise_per_m": 0, "quantisation_per_m": 0},
  "renderer": {"name": "proxy"},
  "trajectory": {"name": "follow-surface"}, "safety": {"ramp_s": 0.05}})";

inline Experiment press_experiment() {
  return Experiment::from_json(kPress, "test");
}
inline double table_height_m() {
  return press_experiment().build_scenario(scenes::kernels())->surface_height(0, 0, 0);
}

// The hand is above the table until kPressed_s, then 2 mm below it.
constexpr double kAbove_m = 0.03, kBelow_m = -0.002, kPressed_s = 0.2;

// Puts the handle of the device at a place, in our axes.
inline void put(DeviceDouble& device, const VendorDevice& vendor, const Vec3& place_m) {
  const Vec3 place = vendor.length_per_m * (vendor.axes * place_m);
  device.set([&](DeviceDouble::State& state) { Vec3::Map(state.position.data()) = place; });
}

// The force at the device's side over time, from each moment to the next. If there are several at one moment,
// the last counts.
struct ForceOverTime {
  struct Piece {
    std::int64_t from_ns;
    double force_N;
  };
  std::vector<Piece> pieces;

  double at(std::int64_t moment_ns) const {
    double force_N = 0;
    for (const Piece& piece : pieces)
      if (piece.from_ns <= moment_ns) force_N = piece.force_N;
    return force_N;
  }
  double max_in(std::int64_t from_ns, std::int64_t to_ns) const {
    double max_N = at(from_ns);
    for (const Piece& piece : pieces)
      if (piece.from_ns > from_ns && piece.from_ns < to_ns) max_N = std::max(max_N, at(piece.from_ns));
    return max_N;
  }
  // Returns the moment from which on there is no force any more. Returns -1 if there was no force, or if it
  // has not ended.
  std::int64_t force_end_ns() const {
    std::int64_t force_end_ns = -1;
    bool has_force = false;
    for (const Piece& piece : pieces) {
      if (has_force && piece.force_N == 0) force_end_ns = piece.from_ns;
      has_force = piece.force_N > 0;
    }
    return has_force ? -1 : force_end_ns;
  }
};
inline ForceOverTime force_of(const DeviceDouble& device) {
  ForceOverTime force;
  for (const DeviceDouble::Event& event : device.events())
    force.pieces.push_back({event.at_ns, event.force()});
  return force;
}

}  // namespace remote_touch
