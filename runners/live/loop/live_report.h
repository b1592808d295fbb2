// The report of a live run: its inputs, its timing as a table and a figure, and notes; and the lateness of
// ticks on this machine.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "analysis/storage/result_file.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/live/devices/clock.h"
#include "runners/live/loop/live_log.h"

namespace remote_touch {

// Returns the recordings, sessions and meshes that run_live() opens with this device and this sensor, for the
// hashes in its results:
// - the files of --depth and of --device replay:;
// - the recording of the scenario, if the scenario is the sensor (sim:), or if a hand is simulated (sim:,
//   browser:, replay:), because its motion is planned in the scenario. has_view: the page of --view shows
//   where that motion begins, so the recording is read too;
// - the file of the trajectory, if the device is sim: or browser:, or there is a page;
// - the files of all other sections of the experiment.
// Throws InputError for an address without a known scheme.
std::vector<InputPart> live_inputs(const Experiment& experiment, const std::string& device,
                                   const std::string& depth, bool has_view);

// Returns the phases of a live session: those of Experiment::phases(); those of the scene if the sensor is
// simulated (depth "sim:..."); and those of the hand and the operator if the device is simulated (device
// "sim:...").
std::vector<Phase> simulated_phases(const Experiment& experiment, const std::string& device,
                                    const std::string& depth, const Kernels& kernels);

struct LiveFacts {
  std::string depth;  // the address of the sensor, such as "sim:"
  const SensorView& view;
  const SensedPoints& sensed;  // the frames that were sent to the renderer
  const CameraCounts& camera;
  const LiveLog& log;
  double haptic_rate_hz = 0;
  const std::vector<Phase>& phases;  // see simulated_phases()
};

// Returns one input line, on the frames, and these notes: no frame; no contact; frames unused, if more than a
// tenth of all frames were not used; phase not reached.
RunReport report_of(const LiveFacts& facts);

// Timing of a live run: a text table and a figure.
struct LiveReport {
  struct Times {
    const char* name;
    const char* key;             // file-safe
    std::vector<double> sorted;  // seconds; only a part of them after a long run, see Samples
    std::size_t count;           // number of all times
    double least, greatest;      // least and greatest of all times
  };
  struct Count {
    const char* name;
    double value;  // NaN if there was nothing to measure
  };
  std::vector<Times> times;
  std::vector<Count> counts;
  // max_interval_s: longest time from tick to tick in each piece of the run; piece_s: start of the piece.
  std::vector<double> piece_s, max_interval_s;
};

LiveReport live_report(const LiveLog& log, const LiveCounts& counts);

// Returns a text table: least time, p50, p99, p99.9 and greatest time in each row, then the counts. A
// number that could not be measured is "none".
std::string text(const LiveReport& report);

// Returns the tables `times` and `counts` with the same numbers, the distributions of the times, and a curve
// of the longest time from tick to tick over the run.
Figure live_figure(const LiveReport& report);

// Returns the value at this fraction of the sorted values, by the nearest index; NaN if there are no values.
double quantile(const std::vector<double>& sorted, double fraction);

// Measures the lateness of the ticks of a haptic loop on this machine; the ticks themselves do nothing.
struct Jitter {
  std::vector<double> late_s;  // delay of every tick
  long long missed = 0;        // ticks that never began
  std::string real_time;       // rights that the system granted, see become_real_time()
};

// Measures the loop that is used for devices without a loop of their own. stop: may end it early; may be
// null.
Jitter measure_jitter(double duration_s, double rate_hz, const std::atomic<bool>* stop, Clock& clock);

// Returns rows of "from to count bar". Each row ends at twice the time of the row before; empty rows are
// omitted.
std::string histogram(const std::vector<double>& late_s);

}  // namespace remote_touch
