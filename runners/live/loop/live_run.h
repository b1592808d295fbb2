// The live loop: sensor, renderer and device in real time. runners/simulation/simulation.cpp is the same in
// simulated time.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>

#include "analysis/storage/hdf5_file.h"
#include "core/kernels/kernels.h"
#include "runners/experiment/experiment.h"
#include "runners/live/loop/live_report.h"

namespace remote_touch {

struct LiveOptions {
  std::string device = "sim:", depth = "sim:";
  double duration_s = 0;                                // 0: until told to stop
  std::filesystem::path record;                         // empty: nothing is recorded
  TextAttributes provenance;                            // of the recording
  double stall_s = 0.01;                                // without a tick for longer the device is let go
  const Kernels* kernels = nullptr;                     // required
  const std::atomic<bool>* stop = nullptr;              // SIGINT and SIGTERM
  std::atomic<bool>* report = nullptr;                  // SIGUSR1: on_report now; set back
  std::atomic<bool>* rearm = nullptr;                   // SIGUSR2: after a latch; set back
  std::function<void(const std::string&)> report_line;  // lines to the user while it runs
  // Of the run until now, from the thread that writes the recording: nobody else writes HDF5 then.
  std::function<void(const LiveReport&)> on_report;
};

struct LiveResult {
  LiveLog log;
  LiveCounts counts;
  std::string real_time;   // what the system gave
  std::string device;      // its name
  double force_scale = 1;  // of what was rendered, for the device's largest stiffness
  std::string ended;       // why it ended
  bool failed = false;     // device, sensor, disk or renderer, or force was latched off at the end
};

// Throws InputError when something cannot be opened; then nothing has moved.
LiveResult run_live(const Experiment& experiment, const LiveOptions& options);

}  // namespace remote_touch
