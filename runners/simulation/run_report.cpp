#include "runners/simulation/run_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/parameters/input_error.h"
#include "core/search/neighbour_search.h"

namespace remote_touch {

namespace {

std::string seconds(double time_s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g s", time_s);
  return text;
}

// A press into a moving scene that begins when the scene has come to rest.
void add_late_phases(const std::vector<Phase>& of_scene, const std::vector<Phase>& of_hand, double end_s,
                     std::vector<Note>& notes) {
  if (of_scene.empty()) return;
  const Phase& last = of_scene.back();
  for (const Phase& phase : of_hand)
    if (phase.begins_s >= last.ends_s && phase.begins_s < end_s)
      notes.push_back({"after the motion", phase.name + " begins at " + seconds(phase.begins_s) + ", after " +
                                               last.name + " has ended at " + seconds(last.ends_s)});
}

void add_contact(const Trace& trace, std::vector<Note>& notes) {
  const auto is_none = [](int count) { return count == 0; };
  const auto is_zero = [](const Vec3& force) { return force.norm() == 0; };
  if (std::all_of(trace.frame_index.begin(), trace.frame_index.end(), [](int frame) { return frame < 0; }))
    notes.push_back({"no frame", "no frame arrived before the run ended"});
  else if (std::all_of(trace.contact_count.begin(), trace.contact_count.end(), is_none) &&
           std::all_of(trace.force_N.begin(), trace.force_N.end(), is_zero))
    notes.push_back(no_contact_note());
}

// The points of a frame within a ball, in the order of the search: rows of an image stay together.
std::vector<Vec3> points_in(const NeighbourSearch& frame, const Ball& ball, const Kernels& kernels) {
  GatheredPoints found;
  found.reserve(frame.size(), frame.has_fixture_radius(), frame.has_stiffness());
  frame.gather(ball, kernels, found);
  const PointsView view = found.view();
  std::vector<Vec3> near;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Vec3 p(view.x[i], view.y[i], view.z[i]);
    if ((p - ball.centre).norm() <= ball.radius) near.push_back(p);  // regions reach farther than points
  }
  return near;
}

// Searches outwards from point i, because successive points are mostly neighbours.
bool has_neighbour(const std::vector<Vec3>& points, std::size_t i, double within_m) {
  const auto is_near = [&](std::size_t j) { return (points[i] - points[j]).norm() <= within_m; };
  for (std::size_t step = 1; step <= i || i + step < points.size(); ++step)
    if ((step <= i && is_near(i - step)) || (i + step < points.size() && is_near(i + step))) return true;
  return false;
}

// The median distance of points to their nearest neighbour is larger than the limit: no more than half of
// them have a neighbour within it.
bool are_apart(const std::vector<Vec3>& points, double limit_m) {
  std::size_t close = 0;
  for (std::size_t i = 0; i < points.size() && close <= points.size() / 2; ++i)
    close += has_neighbour(points, i, limit_m) ? 1 : 0;
  return close <= points.size() / 2;
}

// Median distance of the points to their nearest neighbour; infinite if a point is alone.
double spacing_m(const std::vector<Vec3>& near) {
  std::vector<double> nearest_m;
  for (const Vec3& p : near) {
    double least_m = std::numeric_limits<double>::infinity();
    for (const Vec3& q : near)
      if (&p != &q) least_m = std::min(least_m, (p - q).norm());
    nearest_m.push_back(least_m);
  }
  if (nearest_m.empty()) return std::numeric_limits<double>::infinity();
  const auto middle = nearest_m.begin() + static_cast<std::ptrdiff_t>(nearest_m.size() / 2);
  std::nth_element(nearest_m.begin(), middle, nearest_m.end());
  return *middle;
}

}  // namespace

Note no_contact_note() {
  return {"no contact", "no contact: no point was touched, and no force was felt"};
}

void add_missed_phases(const std::vector<Phase>& phases, double end_s, std::vector<Note>& notes) {
  for (const Phase& phase : phases)
    if (phase.begins_s >= end_s)
      notes.push_back({"phase not reached", "the run ends at " + seconds(end_s) + ", before " + phase.name +
                                                " begins at " + seconds(phase.begins_s)});
}

std::vector<Note> spacing_notes(const Scenario& scenario, const Trace& trace, double contact_radius_m,
                                const Kernels& kernels) {
  const auto touched = std::find_if(trace.contact_count.begin(), trace.contact_count.end(),
                                    [](int count) { return count > 0; });
  if (touched == trace.contact_count.end()) return {};
  const auto tick = static_cast<std::size_t>(touched - trace.contact_count.begin());
  const int frame = std::min(trace.frame_index[tick], scenario.frame_count() - 1);
  const double limit_m = std::sqrt(2.0) * contact_radius_m;
  const std::vector<Vec3> near =
      points_in(*scenario.points(frame), {trace.proxy_position_m[tick], 3 * contact_radius_m}, kernels);
  if (!are_apart(near, limit_m)) return {};
  char text[200];
  std::snprintf(
      text, sizeof text,
      "the points near the first contact are %.3g mm apart: a proxy of contact radius %.3g mm falls through "
      "between points farther apart than %.3g mm",
      1e3 * spacing_m(near), 1e3 * contact_radius_m, 1e3 * limit_m);
  return {{"wide spacing", text}};
}

std::string text_of(const RunReport& report) {
  std::string text;
  for (const std::string& line : report.inputs) text += "  read " + printable(line) + "\n";
  for (const Note& note : report.notes) text += "  note: " + printable(note.text) + "\n";
  return text;
}

RunReport report_of(const Scenario& scenario, const Trajectory& trajectory, const Trace& trace,
                    double end_s) {
  RunReport report;
  if (std::string input = scenario.input(); !input.empty()) report.inputs.push_back(std::move(input));
  report.notes = scenario.input_notes();
  for (Note& note : trajectory.notes()) report.notes.push_back(std::move(note));
  const std::vector<Phase> of_scene = scenario.phases(), of_hand = trajectory.phases();
  add_missed_phases(of_scene, end_s, report.notes);
  add_missed_phases(of_hand, end_s, report.notes);
  // A ticks' time is made of its number, and the end of a motion is a sum of times: both are rounded.
  if (trajectory.duration_s() > end_s + kSameTime_s)
    report.notes.push_back({"phase not reached", "the run ends at " + seconds(end_s) +
                                                     ", before the trajectory ends at " +
                                                     seconds(trajectory.duration_s())});
  add_late_phases(of_scene, of_hand, end_s, report.notes);
  add_contact(trace, report.notes);
  return report;
}

void add_report(TextAttributes& attributes, const RunReport& report) {
  std::string read, notes;
  for (const std::string& line : report.inputs) read += (read.empty() ? "" : "\n") + line;
  for (const Note& note : report.notes) notes += (notes.empty() ? "" : "\n") + note.text;
  if (!read.empty()) attributes.emplace_back("frames_read", read);
  if (!notes.empty()) attributes.emplace_back("notes", notes);
}

void refuse_notes(const RunReport& report) {
  if (!report.notes.empty()) throw InputError("--strict", report.notes.front().text);
}

}  // namespace remote_touch
