#include "runners/experiment/simulation/run_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "analysis/trace/trace.h"
#include "core/parameters/parameter.h"

namespace remote_touch {
namespace {

std::string seconds(double time_s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g s", time_s);
  return text;
}

// Adds a note for each phase of the hand, such as a press, that begins only after the motion of the scene has
// ended.
void add_late_phases(const std::vector<Phase>& of_scene, const std::vector<Phase>& of_hand, double end_s,
                     std::vector<Note>& notes) {
  if (of_scene.empty()) return;
  const Phase& last = of_scene.back();
  for (const Phase& phase : of_hand)
    if (phase.begins_s >= last.ends_s && phase.begins_s < end_s)
      notes.push_back({"after the motion", phase.name + " begins at " + seconds(phase.begins_s) + ", after " +
                                               last.name + " has ended at " + seconds(last.ends_s)});
}

// Returns the number of frames that the renderer used in a part of the run.
int frames_between(const Trace& trace, double begins_s, double ends_s) {
  int frames = 0, newest = -1;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    const bool is_inside = trace.time_s[i] > begins_s - kSameTime_s && trace.time_s[i] < ends_s + kSameTime_s;
    if (!is_inside || trace.frame_index[i] == newest) continue;
    newest = trace.frame_index[i];
    ++frames;
  }
  return frames;
}

// Adds a note if the renderer used only one or two frames while the scene moved. A motion that lasts less
// than 0.2 s in this run gets no note, because few frames of an ordinary rate are in it.
void add_few_frames(const std::vector<Phase>& of_scene, const Trace& trace, double end_s,
                    std::vector<Note>& notes) {
  constexpr double kBriefMotion_s = 0.2;
  constexpr int kEnoughFrames = 3;
  if (of_scene.empty()) return;
  double begins_s = end_s, ends_s = 0;
  for (const Phase& phase : of_scene) {
    begins_s = std::min(begins_s, std::max(0.0, phase.begins_s));  // no NaN: settings
    ends_s = std::max(ends_s, std::min(end_s, phase.ends_s));      // no NaN
  }
  const int frames = frames_between(trace, begins_s, ends_s);
  if (frames == 0 || frames >= kEnoughFrames || ends_s - begins_s < kBriefMotion_s) return;
  notes.push_back({"few frames", std::to_string(frames) + (frames == 1 ? " frame" : " frames") + " in the " +
                                     seconds(ends_s - begins_s) + " in which the scene moves: its motion " +
                                     (frames == 1 ? "after this frame" : "between and after them") +
                                     " is not seen"});
}

void add_contact(const Trace& trace, std::vector<Note>& notes) {
  const auto is_none = [](int count) { return count == 0; };
  const auto is_zero = [](const Vec3& force) { return force.norm() == 0; };
  if (std::ranges::all_of(trace.frame_index, [](int frame) { return frame < 0; }))
    notes.push_back({"no frame", "no frame arrived before the run ended"});
  else if (std::ranges::all_of(trace.contact_count, is_none) && std::ranges::all_of(trace.force_N, is_zero))
    notes.push_back(no_contact_note());
}

// Adds a note if the renderer's force or torque is not a finite number in some tick.
void add_unknown_forces(const Trace& trace, std::vector<Note>& notes) {
  std::size_t count = 0, first = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    if (trace.force_N[i].allFinite() && (!trace.has_tool() || trace.torque_Nm[i].allFinite())) continue;
    if (count++ == 0) first = i;
  }
  if (count == 0) return;
  notes.push_back({"force not finite", "the renderer's force is not a finite number in " +
                                           std::to_string(count) + " of " + std::to_string(trace.length()) +
                                           " ticks, first at " + seconds(trace.time_s[first]) +
                                           ": it counts as no force there"});
}

}  // namespace

Note no_contact_note() {
  return {"no contact", "no point was touched, and no force was felt"};
}

void add_missed_phases(const std::vector<Phase>& phases, double end_s, std::vector<Note>& notes) {
  std::set<std::string> missed;
  for (const Phase& phase : phases)
    if (phase.begins_s >= end_s && missed.insert(phase.name).second)
      notes.push_back({"phase not reached", "the run ends at " + seconds(end_s) + ", before " + phase.name +
                                                " begins at " + seconds(phase.begins_s)});
}

std::string text_of(const RunReport& report) {
  std::string text;
  for (const std::string& line : report.inputs) text += "  read " + printable(line) + "\n";
  if (!report.hand.empty()) text += "  hand: " + printable(report.hand) + "\n";
  for (const Note& note : report.notes)
    text += "  note (" + printable(note.kind) + "): " + printable(note.text) + "\n";
  return text;
}

RunReport report_of(const Scenario& scenario, const Trajectory& trajectory, const Trace& trace,
                    double end_s) {
  RunReport report;
  if (std::string input = scenario.input(); !input.empty()) report.inputs.push_back(std::move(input));
  report.hand = trajectory.aim();
  report.notes = scenario.input_notes();
  for (Note& note : trajectory.notes()) report.notes.push_back(std::move(note));
  const std::vector<Phase> of_scene = scenario.phases(), of_hand = trajectory.phases();
  add_missed_phases(of_scene, end_s, report.notes);
  add_missed_phases(of_hand, end_s, report.notes);
  // The time of a tick is computed from its number, and the end of a motion is a sum of times. Both are
  // rounded, so times that are nearly equal count as equal.
  if (trajectory.duration_s() > end_s + kSameTime_s)
    report.notes.push_back({"phase not reached", "the run ends at " + seconds(end_s) +
                                                     ", before the trajectory ends at " +
                                                     seconds(trajectory.duration_s())});
  add_late_phases(of_scene, of_hand, end_s, report.notes);
  add_few_frames(of_scene, trace, end_s, report.notes);
  add_contact(trace, report.notes);
  add_unknown_forces(trace, report.notes);
  return report;
}

void add_report(TextAttributes& attributes, const RunReport& report) {
  std::string read, notes;
  for (const std::string& line : report.inputs) read += (read.empty() ? "" : "\n") + line;
  for (const Note& note : report.notes) notes += (notes.empty() ? "" : "\n") + note.text;
  if (!read.empty()) attributes.emplace_back("frames_read", read);
  if (!report.hand.empty()) attributes.emplace_back("hand", report.hand);
  if (!notes.empty()) attributes.emplace_back("notes", notes);
}

void refuse_notes(const RunReport& report) {
  std::string all;
  for (const Note& note : report.notes) all += (all.empty() ? "" : "; ") + note.kind + ": " + note.text;
  if (!all.empty()) throw InputError("--strict", all);
}

namespace {

constexpr std::size_t kMainMeasures = 5;

enum class When { always, fixtures, no_fixtures };

// The first five that apply to the run and have a value are printed. So a run without a known truth or
// without a tool has the next ones instead.
struct Priority {
  const char* measure;
  When when;
  const char* unless = "";  // another measure, with which this one is left out
};
constexpr Priority kPriorities[] = {
    // Did the slave touch, how hard, and what did the hand feel of it?
    {"max_slave_force", When::always},
    {"min_slave_clearance", When::always},
    {"max_device_force", When::always},
    // A region is violated if the slave comes too near to the surface behind it.
    {"min_slave_distance", When::fixtures},
    // Guidance has to lead the hand to its goal.
    {"guidance_error", When::always},
    {"guidance_error_angle", When::always},
    // The first question about a method: does its proxy stay on the right side of the surface? Where a camera
    // measured the surface, the second is on which side of the true one that is.
    {"popped_through", When::no_fixtures},
    {"popped_through_truth", When::no_fixtures},
    {"first_pop_through_time", When::no_fixtures},  // has no value unless it happened
    {"tool_popped_through", When::no_fixtures},
    // How far was it wrong? The depth of points in a tool needs no truth.
    {"max_penetration", When::no_fixtures, "popped_through_truth"},
    {"max_tool_penetration", When::always},
    // How well does the hand feel the shape?
    {"rms_contact_error", When::no_fixtures},
    // The error has two parts, of the camera and of the renderer.
    {"rms_camera_error", When::no_fixtures},
    {"rms_renderer_error", When::no_fixtures},
    // How much does the device have to exert, and how large is the jolt when a frame arrives?
    {"max_force", When::always},
    {"max_force_jump", When::always},
    {"max_torque", When::always},
    // Was there a contact, and did the steps of a tick suffice?
    {"force_fraction", When::always},
    {"unconverged_fraction", When::always},
    {"exhausted_fraction", When::always},
    {"mean_steps", When::always},
};

bool is_wanted(When when, Fixtures fixtures) {
  return when == When::always || (when == When::fixtures) == (fixtures == Fixtures::some);
}

bool is_built_in(const std::string& name) {
  return std::ranges::any_of(built_in_measures(), [&](const Measure& each) { return each.name == name; });
}

struct UnitName {
  const char *unit, *words;
};
constexpr UnitName kUnitNames[] = {
    {"1", ""},
    {"m", "metres"},
    {"s", "seconds"},
    {"N", "newtons"},
    {"J", "joules"},
    {"rad", "radians"},
    {"N m", "newton metres"},
    {"1/s", "per second"},
    {"N/m", "newtons per metre"},
};

}  // namespace

std::vector<MeasuredValue> measured_values(std::span<const Measure> list, const Trace& trace) {
  std::vector<MeasuredValue> values;
  for (const Measure& measure : list)
    if (applies(measure, trace)) values.push_back({&measure, measure.compute(trace)});
  return values;
}

std::vector<MeasuredValue> main_measures(const std::vector<MeasuredValue>& all, Fixtures fixtures) {
  std::vector<MeasuredValue> chosen;
  const auto find = [&](const std::string& name) {
    return std::ranges::find_if(all, [&](const MeasuredValue& each) { return each.measure->name == name; });
  };
  for (const Priority& priority : kPriorities) {
    const auto found = find(priority.measure);
    if (found == all.end() || std::isnan(found->value) || !is_wanted(priority.when, fixtures)) continue;
    if (find(priority.unless) != all.end()) continue;
    chosen.push_back(*found);
    if (chosen.size() == kMainMeasures) break;
  }
  for (const MeasuredValue& each : all)
    if (!is_built_in(each.measure->name)) chosen.push_back(each);
  return chosen;
}

std::string unit_in_words(const std::string& unit) {
  for (const UnitName& name : kUnitNames)
    if (unit == name.unit) return name.words;
  return unit;
}

}  // namespace remote_touch
