#include "analysis/measures/force_change_measures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/measures/contact_force.h"
#include "analysis/measures/no_value.h"
#include "analysis/statistics/extremes.h"
#include "analysis/statistics/mean.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

namespace {

// Change of a force or torque from one tick to the next.
struct Change {
  double max = 0, squares = 0, count = 0;
  double tick = kNoValue;  // number of the first tick with the maximum; NaN if all are 0 or one is unknown

  double max_or_none() const { return count == 0 ? kNoValue : max; }
  double rms_or_none() const { return count == 0 ? kNoValue : std::sqrt(squares / count); }
};

// Collects the changes at the ticks with a frame update if at_updates, else those at the other ticks. of(i):
// the vector of tick i. A change counts if the vector of this tick or of the one before is not zero; the
// result is unknown if one of them is.
template <class Vector>
Change change(const Trace& trace, Vector&& of, bool at_updates) {
  Change found;
  for (std::size_t i = 1; i < trace.length(); ++i) {
    if (trace.frame_update(i) != at_updates) continue;
    const Vec3 before = of(i - 1), now = of(i);
    if (now.isZero(0) && before.isZero(0)) continue;
    const double squared = (now - before).squaredNorm(), max = max_or_nan(found.max, std::sqrt(squared));
    if (max != found.max) found.max = max, found.tick = std::isnan(max) ? kNoValue : static_cast<double>(i);
    found.squares += squared, ++found.count;
  }
  return found;
}

Change force_change(const Trace& trace, bool at_updates) {
  return change(
      trace, [&](std::size_t i) { return contact_force_N(trace, i); }, at_updates);
}
Change torque_change(const Trace& trace, bool at_updates) {
  if (!trace.has_tool()) return {};
  return change(
      trace, [&](std::size_t i) { return contact_torque_Nm(trace, i); }, at_updates);
}

// The magnitudes of the force of contact from its first tick on.
struct Settling {
  std::vector<double> magnitude_N;
  std::size_t first = 0;      // the tick of magnitude_N[0]
  double final_N = kNoValue;  // NaN if the force is not steady at the end

  bool is_settled(double size_N) const { return std::abs(size_N - final_N) <= kSettledBand * final_N; }
};

Settling settling_of(const Trace& trace) {
  Settling found;
  while (found.first < trace.length() && contact_force_N(trace, found.first).isZero(0)) ++found.first;
  for (std::size_t i = found.first; i < trace.length(); ++i)
    found.magnitude_N.push_back(contact_force_N(trace, i).norm());
  if (found.magnitude_N.empty()) return found;
  constexpr double kRounding_s = 5e-7;  // times are rounded
  const double from_s = trace.time_s.back() - kFinal_s + kRounding_s;
  std::size_t last = trace.length();  // the first tick of the final time
  while (last > 0 && trace.time_s[last - 1] > from_s) --last;
  if (last == 0 || last < found.first) return found;  // the run or the contact is too short
  const std::vector<double> final_N(
      found.magnitude_N.begin() + static_cast<std::ptrdiff_t>(last - found.first), found.magnitude_N.end());
  found.final_N = mean(final_N);
  const bool is_steady =
      found.final_N > 0 && std::ranges::all_of(final_N, [&](double N) { return found.is_settled(N); });
  if (!is_steady || std::isnan(max_of(found.magnitude_N))) found.final_N = kNoValue;
  return found;
}

}  // namespace

double force_overshoot(const Trace& trace) {
  const Settling run = settling_of(trace);
  if (std::isnan(run.final_N)) return kNoValue;
  constexpr double kRounding = 1e-12;  // the mean is rounded
  const double overshoot = max_of(run.magnitude_N) / run.final_N - 1;
  return overshoot > kRounding ? overshoot : 0;
}

double force_settling_time_s(const Trace& trace) {
  const Settling run = settling_of(trace);
  if (std::isnan(run.final_N)) return kNoValue;
  std::size_t settled = run.magnitude_N.size();
  while (settled > 0 && run.is_settled(run.magnitude_N[settled - 1])) --settled;
  return trace.time_s[run.first + settled] - trace.time_s[run.first];
}

double max_force_jump_N(const Trace& trace) {
  return force_change(trace, true).max_or_none();
}

double max_force_jump_tick(const Trace& trace) {
  return force_change(trace, true).tick;
}

double rms_force_jump_N(const Trace& trace) {
  return force_change(trace, true).rms_or_none();
}

double force_noise_N(const Trace& trace) {
  return force_change(trace, false).rms_or_none();
}

double max_torque_jump_Nm(const Trace& trace) {
  return torque_change(trace, true).max_or_none();
}

double rms_torque_jump_Nm(const Trace& trace) {
  return torque_change(trace, true).rms_or_none();
}

double torque_noise_Nm(const Trace& trace) {
  return torque_change(trace, false).rms_or_none();
}

}  // namespace remote_touch
