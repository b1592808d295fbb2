#include "runners/simulation.h"

#include <bit>
#include <chrono>
#include <cmath>

#include "analysis/fingerprint.h"
#include "core/input_error.h"

namespace remote_touch {

namespace {

// Hands frames over when they arrive.
class FrameStream {
 public:
  FrameStream(const Scenario& scenario, double latency_s, bool hash_frames)
      : scenario_(scenario), latency_s_(latency_s), hash_frames_(hash_frames) {}

  void deliver_until(double time_s, Renderer& renderer) {
    while (next_ < scenario_.frame_count() &&
           scenario_.captured_s(next_) + latency_s_ <= time_s + kSameTime_s) {
      const double captured = scenario_.captured_s(next_);
      const auto points = scenario_.points(next_);
      // Points that come with another time stamp are another frame.
      if (hash_frames_) hash_ = mixed(hash_of(*points), std::bit_cast<std::uint64_t>(captured));
      renderer.on_frame({next_, captured, captured + latency_s_, points});
      ++next_;
    }
  }
  std::uint64_t newest_hash() const { return hash_; }

 private:
  std::uint64_t hash_of(const NeighbourSearch& points) const {
    const auto* stored =
        dynamic_cast<const CloudSearch*>(&points);  // else its points are made when asked for
    return stored ? fingerprint(stored->cloud()) : fingerprint(scenario_.cloud(next_));
  }

  const Scenario& scenario_;
  double latency_s_;
  bool hash_frames_;
  int next_ = 0;
  std::uint64_t hash_ = 0;
};

std::size_t tick_count(const Experiment& experiment, const Trajectory& trajectory) {
  const RunSettings& settings = experiment.settings();
  const double duration = settings.duration_s > 0 ? settings.duration_s : trajectory.duration_s();
  if (!(duration > 0)) throw InputError("duration_s = 0", "the trajectory has no end; allowed above 0");
  // A millionth of a tick is rounding, not a tick more.
  const double ticks = std::ceil(duration * settings.haptic_rate_hz - 1e-6);
  if (!(ticks >= 1))
    throw InputError("duration_s = " + std::to_string(duration),
                     "shorter than a tick; allowed 1 tick or more");
  return static_cast<std::size_t>(ticks);
}

class StopWatch {
 public:
  double lap_s() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> lap = now - start_;
    start_ = now;
    return lap.count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

Trace simulate(const Experiment& experiment, const SimulationOptions& options) {
  const Kernels& kernels = options.kernels ? *options.kernels : kernels_for(best_isa());
  const auto scenario = experiment.build_scenario(kernels);
  const auto trajectory = experiment.build_trajectory(*scenario);
  const auto renderer = experiment.build_renderer(kernels);
  FrameStream frames(*scenario, experiment.settings().frame_latency_s, options.hash_frames);
  const std::size_t ticks = tick_count(experiment, *trajectory);

  Trace trace;
  trace.reserve(ticks);
  StopWatch watch;
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    if (options.stop && *options.stop) throw Interrupted{};
    // Time is made from the tick's number, never added up.
    const double time_s = static_cast<double>(tick) / experiment.settings().haptic_rate_hz;
    frames.deliver_until(time_s, *renderer);
    const DeviceState device = trajectory->at(time_s);
    if (options.step_duration_s) watch.lap_s();
    const RenderOutput out = renderer->step(device, time_s);
    if (options.step_duration_s) options.step_duration_s->push_back(watch.lap_s());
    const double proxy_distance = scenario->signed_distance(out.proxy_W, time_s);
    const double slave_distance =
        out.slave_W == out.proxy_W ? proxy_distance : scenario->signed_distance(out.slave_W, time_s);
    trace.append(time_s, device, out, {proxy_distance, slave_distance, frames.newest_hash()});
    if (options.progress && tick % (ticks / 100 + 1) == 0)
      options.progress(static_cast<double>(tick) / static_cast<double>(ticks));
  }
  return trace;
}

}  // namespace remote_touch
