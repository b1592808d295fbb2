// A whole live run in one thread, on a simulated clock: every step of it happens at an exact time. And a hand
// that presses on a table.
#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/live/devices/device_table.h"
#include "runners/live/loop/live_run.h"
#include "runners/live/sensors/sensor_table.h"
#include "tests/doubles/simulated_clock.h"
#include "tests/doubles/vendor_devices.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch {

class SimulatedRun {
 public:
  using DeviceOpener = std::function<std::unique_ptr<HapticDevice>(const Experiment&, Clock&)>;
  using SourceOpener = std::function<std::unique_ptr<DepthSource>(const Experiment&, Clock&)>;
  struct ReportedLine {
    std::int64_t at_ns;
    std::string line;
  };

  // Events that are to happen during the run must be added to the clock before run().
  SimulatedRun(SimulatedClock& clock, Experiment experiment, DeviceOpener device = simulated_device,
               SourceOpener source = scenario_camera)
      : clock_(clock),
        experiment_(std::move(experiment)),
        open_device_(std::move(device)),
        open_source_(std::move(source)) {
    options.kernels = &scenes::kernels();
    options.report_line = [this](const std::string& line) { reported_.push_back({clock_.now_ns(), line}); };
  }

  static std::unique_ptr<HapticDevice> simulated_device(const Experiment& experiment, Clock& clock) {
    return open_device("sim:", {experiment, scenes::kernels(), clock});
  }
  static std::unique_ptr<DepthSource> scenario_camera(const Experiment& experiment, Clock& clock) {
    return std::make_unique<ScenarioCamera>(experiment.build_scenario(scenes::kernels()), clock);
  }

  // Stores a session that can be simulated again.
  void record(const std::filesystem::path& session) {
    options.record = session;
    options.provenance = {{"config", experiment_.to_json()}};
  }

  LiveOptions options;
  const std::vector<ReportedLine>& reported() const { return reported_; }

  // Runs until its duration, its stop or a failure ends it. The sleeps of the loop do the work that other
  // threads do in run_live(), before a tick of the same moment.
  LiveResult run() {
    LiveParts parts(experiment_, options, clock_, open_device_(experiment_, clock_),
                    open_source_(experiment_, clock_));
    const auto beside = [&](double period_s, std::function<void()> step) {
      return clock_.every(period_s, clock_.now_s(), std::move(step));
    };
    const int steps[] = {
        beside(parts.heartbeat().period_s(), [&] { parts.heartbeat().check(clock_.now_ns()); }),
        beside(1e-3, [&] { parts.camera().step(0); }),
        beside(LiveLogger::kPeriod_s, [&] { parts.logger().step(); }),
        beside(LiveParts::kReportPeriod_s, [&] {
          if (parts.is_over())
            parts.stop();
          else
            parts.report_changes();
        })};
    parts.run_loop();
    for (const int step : steps) clock_.cancel(step);
    return parts.finish();
  }

 private:
  SimulatedClock& clock_;
  const Experiment experiment_;
  const DeviceOpener open_device_;
  const SourceOpener open_source_;
  std::vector<ReportedLine> reported_;
};

// A simulated run that is recorded.
struct RecordedRun {
  RecordedRun(Experiment experiment, double duration_s) : run(clock, std::move(experiment)) {
    run.options.duration_s = duration_s;
    run.record(folder / "session.h5");
  }
  void go() { result = run.run(); }
  // Returns the simulation of the recording.
  Trace again() const {
    SimulationOptions offline;
    offline.kernels = &scenes::kernels(), offline.hash_frames = true;
    return simulate(Experiment::load(run.options.record.string()), offline);
  }
  std::vector<std::string> lines() const {
    std::vector<std::string> lines;
    for (const SimulatedRun::ReportedLine& reported : run.reported()) lines.push_back(reported.line);
    return lines;
  }

  const TestFolder folder{"live"};
  SimulatedClock clock;
  SimulatedRun run;
  LiveResult result;
};

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
