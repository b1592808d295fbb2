#include "runners/evaluation/figures/teleoperation/wall_limit.h"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/means_and_extremes.h"
#include "core/geometry/rotation.h"

namespace remote_touch {

namespace {

constexpr int kHalvings = 7;

// The hand is in contact, on a path at rest, from 1.6 s on. An oscillation that grows is larger in the second
// window.
constexpr double kWindow_s[] = {2.0, 2.8, 3.6};
// Smaller oscillations are the last steps of a proxy, 0.02 mm and less, and not an instability.
constexpr double kLeastSwing_m = 5e-5;
constexpr double kLeastSwing_rad = 5e-4;  // moves the border of a plate by 0.01 mm

double hand_height_m(const Trace& trace, std::size_t i) {
  return trace.hip_position_m[i].y();
}
// The rotation about z, an axis in the plane.
double hand_turn_rad(const Trace& trace, std::size_t i) {
  return rotation_vector(trace.hip_orientation[i]).z();
}

template <class Value>
double swing(const Trace& trace, const Value& value, double from_s, double to_s) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    if (trace.time_s[i] < from_s || trace.time_s[i] >= to_s) continue;
    low = min_or_nan(low, value(trace, i)), high = max_or_nan(high, value(trace, i));
  }
  return high - low;
}

// An unknown position, or a run that ends before its windows, is no proof of stability.
template <class Value>
bool grows(const Trace& trace, const Value& value, double least) {
  const double first = swing(trace, value, kWindow_s[0], kWindow_s[1]);
  const double second = swing(trace, value, kWindow_s[1], kWindow_s[2]);
  return !std::isfinite(first) || !std::isfinite(second) || (second > least && second > first);
}

bool opens(const Trace& trace, double from_s) {
  for (std::size_t i = 0; i < trace.length(); ++i)
    if (trace.time_s[i] >= from_s && !(trace.force_N[i].squaredNorm() > 0)) return true;
  return false;
}

// An oscillation that grows until the hand leaves the surface no longer grows, so a contact that opens counts
// too.
bool is_unstable(const Trace& trace) {
  return grows(trace, hand_height_m, kLeastSwing_m) ||
         (trace.has_tool() && grows(trace, hand_turn_rad, kLeastSwing_rad)) || opens(trace, kWindow_s[1]);
}

}  // namespace

void bisect(FigureContext& context, const std::vector<WallLimit*>& limits) {
  for (int halving = 0; halving < kHalvings; ++halving) {
    std::vector<Experiment> runs;
    for (const WallLimit* limit : limits) runs.push_back(limit->experiment_(limit->middle()));
    const auto unstable = context.measure(runs, is_unstable);
    for (std::size_t i = 0; i < limits.size(); ++i)
      (unstable[i] ? limits[i]->unstable_ : limits[i]->stable_) = limits[i]->middle();
  }
}

}  // namespace remote_touch
