// The simulated haptic loop: frames at the camera's rate, ticks at the haptic rate, recorded in a trace; and
// the report of a run.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/trace/measures.h"
#include "analysis/trace/trace.h"
#include "core/kernels/kernels.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/hand/trajectory.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

// The report of a run: what it read, and notes on what did not happen. It is stored with the result.
struct RunReport {
  std::vector<std::string> inputs;  // one line for each recording, see Scenario::input()
  std::vector<Note> notes;
  std::string hand{};  // pixels that a hand planned on depth images follows, see Trajectory::aim()
};

// end_s: the time of the first tick that was not simulated.
RunReport report_of(const Scenario& scenario, const Trajectory& trajectory, const Trace& trace, double end_s);

// The note "no contact", for a run or a session in which nothing was touched.
Note no_contact_note();

// Adds a note for each phase that begins at end_s or later. Phases of the same name get only one note.
void add_missed_phases(const std::vector<Phase>& phases, double end_s, std::vector<Note>& notes);

// Returns "  read LINE\n" for each input, "  hand: LINE\n" if there is one, and "  note (KIND): TEXT\n" for
// each note.
std::string text_of(const RunReport& report);

// Appends the attributes `frames_read`, `hand` and `notes`, one line for each entry; an attribute without a
// line is left out. The names of the kinds are not stored.
void add_report(TextAttributes& attributes, const RunReport& report);

// Throws InputError with kind and text of every note, for --strict. Does nothing without a note.
void refuse_notes(const RunReport& report);

// The few measures that answer what a user asks first about a run.

// The fixtures of an experiment decide which measures matter: a region keeps the proxy away from the surface.
enum class Fixtures { none, some };

struct MeasuredValue {
  const Measure* measure = nullptr;
  double value = 0;
};
// Returns the measures of a list that apply to the trace, with their values, in the order of the list. The
// pointers are valid as long as the list.
std::vector<MeasuredValue> measured_values(std::span<const Measure> list, const Trace& trace);
// Returns at most five built-in measures from `all`, those that matter most and have a value, and then all
// measures that are not built in, because their author wants to see them.
std::vector<MeasuredValue> main_measures(const std::vector<MeasuredValue>& all, Fixtures fixtures);

// Returns "metres" for "m". Empty for pure numbers ("1"); an unknown unit is returned as it is.
std::string unit_in_words(const std::string& unit);

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
