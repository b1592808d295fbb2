// A whole live run in one thread, on a simulated clock: every step of it happens at an exact time.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "runners/live/devices/device_table.h"
#include "runners/live/loop/live_run.h"
#include "runners/live/sensors/sensor_table.h"
#include "tests/doubles/simulated_clock.h"
#include "tests/support/scenes.h"

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

}  // namespace remote_touch
