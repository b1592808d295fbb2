#include "analysis/measures/perceived_measures.h"

#include <cmath>
#include <vector>

#include "analysis/measures/contact_force.h"
#include "analysis/measures/no_value.h"
#include "analysis/statistics/extremes.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

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

}  // namespace remote_touch
