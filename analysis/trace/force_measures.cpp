#include "analysis/trace/force_measures.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/interval_estimates.h"
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

namespace {

bool is_felt(const Vec3& before_N, const Vec3& after_N, double weber) {
  return (after_N - before_N).norm() > weber * before_N.norm();
}

}  // namespace

double felt_jump_fraction(const Trace& trace, double weber) {
  const std::vector<Vec3>& force_N = trace.force_N;
  return mean_where(
      trace.length(),
      [&](std::size_t i) {
        return trace.frame_update(i) && !(force_N[i - 1].isZero(0) && force_N[i].isZero(0));
      },
      [&](std::size_t i) {
        const bool is_known = force_N[i - 1].allFinite() && force_N[i].allFinite();
        return is_known ? is_felt(force_N[i - 1], force_N[i], weber) : kNoValue;
      });
}

// The last tick has no successor, so its duration is assumed to be the mean of the others.
double deadband_packets_per_s(const Trace& trace, double weber) {
  if (trace.length() < 2) return kNoValue;
  const double intervals = static_cast<double>(trace.length() - 1);
  const double duration_s = (trace.time_s.back() - trace.time_s.front()) * (intervals + 1) / intervals;
  double packets = 1;
  Vec3 sent_N = trace.force_N.front();
  for (const Vec3& force_N : trace.force_N) {
    if (!force_N.allFinite()) return kNoValue;
    if (is_felt(sent_N, force_N, weber)) sent_N = force_N, ++packets;
  }
  return packets / duration_s;
}

namespace {

constexpr double kTimeRounding_s = 5e-7;  // times are rounded: a window of 100 ticks must not lose one

// The change of the force since the tick before, N; at an update without the part that the motion of the hand
// explains.
Vec3 change_N(const Trace& trace, std::size_t i) {
  const std::vector<Vec3>& force_N = trace.force_N;
  const Vec3 change = force_N[i] - force_N[i - 1];
  const bool has_trend = trace.frame_update(i) && i > 1 && !trace.frame_update(i - 1) &&
                         !force_N[i - 1].isZero(0) && !force_N[i - 2].isZero(0);
  return has_trend ? Vec3(change - (force_N[i - 1] - force_N[i - 2])) : change;
}

// The largest Weber fraction at the ticks with a frame update if at_updates, else at the other ticks.
double max_weber_fraction(const Trace& trace, bool at_updates) {
  return max_where(
      trace.length(),
      [&](std::size_t i) {
        return i > 0 && trace.frame_update(i) == at_updates &&
               !(trace.force_N[i - 1].norm() < kMinWeberForce_N);  // or unknown
      },
      [&](std::size_t i) { return change_N(trace, i).norm() / trace.force_N[i - 1].norm(); });
}

// Returns the displacement of the HIP along the surface since the tick before, m; zero if it is too slow to
// count as sliding.
Vec3 sliding_m(const Trace& trace, std::size_t i, const Vec3& normal) {
  const Vec3 moved = trace.hip_position_m[i] - trace.hip_position_m[i - 1];
  const Vec3 along = moved - moved.dot(normal) * normal;
  const double least_m = kSliding_m_per_s * (trace.time_s[i] - trace.time_s[i - 1]);
  return along.norm() >= least_m ? along : Vec3(Vec3::Zero());
}

// Sums over the ticks whose window is in contact.
struct Ripple {
  double squares = 0, magnitudes = 0, ticks = 0;
};

// Adds the ticks of a contact: the ticks from `begin` to `end` (not included), all with a force.
void add_contact(const Trace& trace, std::size_t begin, std::size_t end, Ripple& ripple) {
  constexpr double kHalf_s = 0.5 * kRippleWindow_s + kTimeRounding_s;
  constexpr std::size_t kFewestTicks = 3;
  const std::vector<double>& time_s = trace.time_s;
  const Vec3 first_N = trace.force_N[begin];
  std::vector<Vec3> sums{Vec3::Zero()};  // sum of the forces minus the first one, which keeps rounding small
  for (std::size_t i = begin; i < end; ++i) sums.push_back(sums.back() + (trace.force_N[i] - first_N));
  std::size_t low = begin, high = begin;  // the window
  for (std::size_t i = begin; i < end; ++i) {
    while (time_s[low] < time_s[i] - kHalf_s) ++low;
    while (high < end && time_s[high] <= time_s[i] + kHalf_s) ++high;
    const bool is_whole = time_s[i] - time_s[begin] >= kHalf_s - 2 * kTimeRounding_s &&
                          time_s[end - 1] - time_s[i] >= kHalf_s - 2 * kTimeRounding_s;
    if (!is_whole || high - low < kFewestTicks) continue;
    const Vec3 mean_N = first_N + (sums[high - begin] - sums[low - begin]) / static_cast<double>(high - low);
    ripple.squares += (trace.force_N[i] - mean_N).squaredNorm();
    ripple.magnitudes += trace.force_N[i].norm();
    ++ripple.ticks;
  }
}

Ripple ripple_of(const Trace& trace) {
  const auto is_pushed = [&](std::size_t i) { return !trace.force_N[i].isZero(0); };  // or unknown
  Ripple ripple;
  for (std::size_t begin = 0; begin < trace.length(); ++begin) {
    if (!is_pushed(begin)) continue;
    std::size_t end = begin + 1;
    while (end < trace.length() && is_pushed(end)) ++end;
    add_contact(trace, begin, end, ripple);
    begin = end;
  }
  return ripple;
}

}  // namespace

double max_relative_jump(const Trace& trace) {
  return max_weber_fraction(trace, true);
}

double max_relative_change(const Trace& trace) {
  return max_weber_fraction(trace, false);
}

double apparent_friction(const Trace& trace) {
  double against_N = 0, along_normal_N = 0;
  for (std::size_t i = 1; i < trace.true_normal.size(); ++i) {
    const Vec3& normal = trace.true_normal[i];
    const Vec3 force_N = contact_force_N(trace, i);
    const bool touches = trace.state[i] != static_cast<std::int32_t>(ContactState::free);
    if (!touches || !normal.allFinite() || !force_N.allFinite() || !(force_N.dot(normal) > 0)) continue;
    const Vec3 along_m = sliding_m(trace, i, normal);
    if (along_m.isZero(0)) continue;
    against_N -= force_N.dot(along_m.normalized());
    along_normal_N += force_N.dot(normal);
  }
  return along_normal_N > 0 ? against_N / along_normal_N : kNoValue;
}

double force_ripple_N(const Trace& trace) {
  const Ripple ripple = ripple_of(trace);
  return ripple.ticks == 0 ? kNoValue : std::sqrt(ripple.squares / ripple.ticks);
}

double relative_ripple(const Trace& trace) {
  const Ripple ripple = ripple_of(trace);
  return ripple.ticks == 0 ? kNoValue
                           : std::sqrt(ripple.squares / ripple.ticks) / (ripple.magnitudes / ripple.ticks);
}

namespace {

constexpr PerceptionThreshold kThresholds[] = {
    {"max_relative_jump", "1", 0.07,
     "the change of a constant force of 2.5 to 10 N that is just noticed, as a fraction of the force",
     "X. D. Pang, H. Z. Tan, N. I. Durlach, Manual discrimination of force using active finger motion, 1991"},
    {"apparent_friction", "1", 0.056,
     "the difference of two coefficients of friction of a force-feedback device that is just noticed, at a "
     "coefficient of 0.2, the smallest one tested",
     "W. R. Provancher, N. D. Sylvester, Fingerpad skin stretch increases the perception of virtual "
     "friction, 2009"},
};

}  // namespace

std::span<const PerceptionThreshold> perception_thresholds() {
  return kThresholds;
}

bool is_below(const PerceptionThreshold& threshold, double value) {
  return std::abs(value) < threshold.value;
}

}  // namespace remote_touch
