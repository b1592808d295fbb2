// Measures: scalars of a trace that summarise a run.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace remote_touch {

struct Tolerance;
struct Trace;

// The direction in which a measure gets better.

// not_negative: values of 0 and more are equally good. A smaller gap is no worse, as long as there is a gap.
enum class Better { neither, smaller, larger, near_zero, not_negative };

// The keys are the names of measures. A measure without an entry has no direction.
using Directions = std::map<std::string, Better>;
Better direction_of(const Directions& directions, const std::string& measure);

// True for popped_through and other measures of the outcome of a run. If two runs differ in one of them, no
// other measure decides which is better: a run that lost the surface has no force that could be noisy.
bool is_outcome(const std::string& measure);

// "smaller is better", "has no direction", ...
const char* text_of(Better better);

// Returns a value that is smaller if the measure is better. A measure without a direction keeps its value.
double badness(double value, Better better);

// The judgement of a measure that was compared.
enum class Judgement {
  equal,          // within the tolerance
  within_margin,  // sweeps only: the intervals of the differences lie within the margins
  better,
  worse,
  changed,   // neither: no direction, a number was or became NaN, equally good, or another outcome
  undecided  // sweeps only: too few runs, or similar numbers of better and worse runs
};
bool is_change(Judgement judgement);  // better, worse or changed
// "equal", "within_margin", "better", ...
const char* name_of(Judgement judgement);

// Judges one number: equal, better, worse or changed. A number that was or became NaN is changed, and so is
// one that differs by at most 1e-9 of itself, which may be rounding.
Judgement judge_value(double baseline, double candidate, Better better, const Tolerance& tolerance);

// True for a measure that says nothing about a run without any contact, such as the greatest depth in the
// tool. False for outcomes, and for measures of guidance, of the slave's motion and of an expected force.
bool needs_contact(const std::string& measure);

// 1 when the proxy's centre (with a tool its centre of mass) passed through the surface and ended behind it,
// else 0. The surface is that of judged_distance_m(). The centre is behind it if its distance is less than
// -Trace::held_depth_m, which is 0 for a ball. The result is 0 also if it was behind when the first frame
// came and stayed there. NaN if the distance is not known at the end, or was not known while the centre moved
// to the back: beside an object it may have gone round the border. See contact_measures.h.
double popped_through(const Trace& trace);
// Maximum distance of the proxy's centre behind the true surface, m, over the ticks with a frame and a known
// truth. 0 if it never was behind the surface; NaN if there is no such tick.
double max_penetration_m(const Trace& trace);
// Minimum distance of the slave command to the true surface, m, over the ticks with a known truth; NaN if
// there is no such tick. A fixture of uniform radius is violated by r_f + r_c minus this distance.
double min_slave_distance_m(const Trace& trace);
// Fraction of the ticks with a frame and a known truth in which the proxy's centre lies behind the surface,
// by more than Trace::held_depth_m; NaN if there is no such tick.
double wrong_side_fraction(const Trace& trace);
// Force dropouts: of the ticks in which the surface holds the proxy back (see pressing()), the fraction
// without a force. NaN if there is no such tick.
double no_force_fraction(const Trace& trace, double contact_radius_m);
// Proxy steps per tick.
double mean_steps(const Trace& trace);
double max_steps(const Trace& trace);
// Fraction of the ticks that ended without convergence (4.8).
double unconverged_fraction(const Trace& trace);
// Fraction of the ticks with a number that is not finite in position, force or normal; with a tool also in
// torque or orientation, with a simulated hand also in what the device exerts.
double non_finite_fraction(const Trace& trace);
double max_force_N(const Trace& trace);

// The runs for which a measure is defined. all: every run. proxy: runs with a point proxy. contact: runs with
// a point proxy for which Trace::contact was computed. tool: runs with a tool. guidance: runs with guidance.
// true_normal: runs for which Trace::true_normal was computed and is known in at least one tick. replay: runs
// that replay a contact whose force is known (Trace::expected_force_N). measured_surface: runs of `contact`
// with a measured surface beside the true one (Trace::measured_distance_m). slave: runs with a slave.
enum class MeasuredRuns { all, proxy, contact, tool, guidance, true_normal, replay, measured_surface, slave };

// A measure that needs only a trace, by name: for summaries and for sweeps.
struct Measure {
  std::string name;
  std::string unit;     // "m", "N/s"; "1" for a ratio or a count
  std::string meaning;  // one line that continues "the measure is the ..."
  MeasuredRuns runs = MeasuredRuns::all;
  std::function<double(const Trace&)> compute;  // NaN if it has no value; called from many threads
  // The direction in which it gets better. It is the last member, so that a program may omit it.
  Better better = Better::neither;
};
// The measures of this program, in the order in which summaries print them. A program may have more, see
// runners/experiment/catalog/catalog.h.
const std::vector<Measure>& built_in_measures();
bool applies(const Measure& measure, const Trace& trace);
// True if the measure needs Trace::contact or Trace::true_normal, which are not stored as columns.
bool needs_true_contact(const Measure& measure);
const char* name_of(MeasuredRuns runs);  // "all runs", "runs without a tool", ...
// NaN if the measure does not apply.
double value_of(const Measure& measure, const Trace& trace);

}  // namespace remote_touch
