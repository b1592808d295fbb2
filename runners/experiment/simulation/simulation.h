// The simulated haptic loop: frames at the camera's rate, ticks at the haptic rate, recorded in a trace.
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "analysis/trace/trace.h"
#include "core/kernels/kernels.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/run_report.h"

namespace remote_touch {

struct SimulationOptions {
  const Kernels* kernels = nullptr;                 // null: the machine's best
  const std::atomic<bool>* stop = nullptr;          // when set, the run ends with Interrupted
  std::function<void(double fraction)> progress;    // called about a hundred times
  std::vector<double>* step_duration_s = nullptr;   // wall-clock time of each tick; null: not measured
  std::vector<double>* frame_duration_s = nullptr;  // wall-clock time of each on_frame(); null: not measured
  std::function<void(const Frame&)> on_frame;       // called with each frame, before the renderer
  RunReport* report = nullptr;                      // receives what the run read and its notes
  bool generate_all_points =
      false;  // compute every point before on_frame(), so that durations do not include the noise
  bool find_true_contact = false;  // fill Trace::contact and true_normal, for measures that need them
  bool hash_frames = false;        // compute every point of every frame for the trace's frame_hash; else 0
};

struct Interrupted {};

// Runs an experiment. The same experiment gives the same bits. Throws InputError if the scenario, the
// trajectory or the renderer cannot be built, if the run has no duration, or if a frame cannot be used.
// Throws Interrupted if `stop` is set.
Trace simulate(const Experiment& experiment, const SimulationOptions& options = {});

}  // namespace remote_touch
