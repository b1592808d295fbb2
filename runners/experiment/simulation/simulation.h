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

struct Trace;

struct SimulationOptions {
  const Kernels* kernels = nullptr;                 // null: the machine's best
  const std::atomic<bool>* stop = nullptr;          // when set, the run ends with Interrupted
  std::function<void(double fraction)> progress;    // called about a hundred times
  std::vector<double>* step_duration_s = nullptr;   // wall-clock time of each tick; null: not measured
  std::vector<double>* frame_duration_s = nullptr;  // and of the renderer's work on each frame
  std::function<void(const Frame&)> on_frame;       // sees each frame that arrives, before the renderer
  RunReport* report = nullptr;                      // receives what the run read and its notes
  bool generate_all_points =
      false;  // frames come with every point computed: durations without noise generation
  bool find_true_contact = false;  // fill Trace::contact and true_normal, for measures that need them
  bool hash_frames = false;        // compute every point of every frame for the trace's frame_hash; else 0
};

struct Interrupted {};

// Same experiment, same bits. Throws InputError when the scenario or trajectory cannot be built.
Trace simulate(const Experiment& experiment, const SimulationOptions& options = {});

}  // namespace remote_touch
