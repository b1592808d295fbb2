// The live loop: sensor, renderer and device in real time. runners/experiment/simulation/simulation.cpp does
// the same in simulated time.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>

#include "analysis/storage/hdf5_file.h"
#include "core/kernels/kernels.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/live/devices/built_in_devices.h"
#include "runners/live/loop/live_report.h"
#include "runners/live/loop/servo.h"

namespace remote_touch {

// The parts of a running live session that do not work at the moment, as texts for the user. Each text is a
// statement that is true now; it is empty if there is nothing to report.
struct LiveTrouble {
  std::string camera;  // why the scene does not change
  std::string force;   // why the device gets no force, and what the user can do

  bool operator==(const LiveTrouble&) const = default;
};

struct LiveOptions {
  std::string device = "sim:", depth = "sim:";
  double duration_s = 0;                                // 0: until stopped
  std::filesystem::path record;                         // empty: nothing is recorded
  TextAttributes provenance;                            // attributes of the recording
  double stall_s = 0.01;                                // the device is released if no tick comes for longer
  const Kernels* kernels = nullptr;                     // required
  const std::atomic<bool>* stop = nullptr;              // SIGINT and SIGTERM
  std::atomic<bool>* report = nullptr;                  // set by SIGUSR1; calls on_report and is reset
  std::atomic<bool>* rearm = nullptr;                   // set by SIGUSR2; re-arms after a latch and is reset
  std::function<void(const std::string&)> report_line;  // lines to the user while it runs
  std::function<void()> on_start;                       // device and sensor are open, and the loop begins
  // Called after the loop, before the recording is finished. It throws InputError if a file that the run has
  // read has changed meanwhile. Empty: no check.
  std::function<void()> check_inputs;
  // Report of the run so far, called from the thread that writes the recording, so that no other thread uses
  // HDF5.
  std::function<void(const LiveReport&)> on_report;
  // Called for a viewer: on_tick with every tick, in the thread that writes the recording; on_frame with
  // every frame on its way to the renderer, in the camera's thread. They must not throw.
  std::function<void(const LiveTick&)> on_tick;
  std::function<void(const Frame&)> on_frame;
  // Called in the thread of run_live() whenever the texts about what does not work have changed, also if
  // report_line is empty.
  std::function<void(const LiveTrouble&)> on_trouble;
  std::shared_ptr<HandPoses> poses;        // required by the device browser:
  std::shared_ptr<LiveControls> controls;  // must belong to the same experiment; null: nothing changes
};

struct LiveResult {
  LiveLog log;
  LiveCounts counts;
  RunReport report;        // the frames that it read, and notes; empty if the log failed
  std::string real_time;   // rights that the system granted, see become_real_time()
  std::string device;      // its name
  double force_scale = 1;  // factor on the rendered force, for the device's maximum stiffness
  std::string ended;       // reason why it ended
  bool failed = false;     // device, sensor or renderer failed, or the gate was latched at the end
  // An input error in one line: a frame does not fit the view of its sensor, the renderer or the simulated
  // hand cannot use a frame, or an input file has changed. Empty: none of these.
  std::string refused;
  std::string lost;  // why the recording or the log is not whole, or there was no memory; empty: neither
};

// Throws InputError if something cannot be opened; then no force was exerted. Throws std::runtime_error if an
// exception ended the run and a file keeps the recording; the message names the file.
LiveResult run_live(const Experiment& experiment, const LiveOptions& options);

}  // namespace remote_touch
