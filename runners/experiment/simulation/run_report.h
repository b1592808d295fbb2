// The report of a run: what it read, and notes on what did not happen. It is stored with the result.
#pragma once

#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "runners/experiment/hand/trajectory.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

struct Trace;

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

}  // namespace remote_touch
