#include "runners/evaluation/figures/teleoperation/wall_limit.h"

#include <algorithm>

namespace remote_touch {

namespace {

constexpr double kTick_s = 0.001;
constexpr int kHalvings = 7;

// The hand is in contact, on a path at rest, from 1.6 s on. An oscillation that grows is larger in the second
// window.
constexpr double kWindow_s[] = {2.0, 2.8, 3.6};
// Smaller oscillations are the last steps of a proxy, 0.02 mm and less, and not an instability.
constexpr double kLeastSwing_m = 5e-5;

double swing_m(const Trace& trace, double from_s, double to_s) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    if (trace.time_s[i] < from_s || trace.time_s[i] >= to_s) continue;
    low = std::min(low, trace.hip_position_m[i].y()), high = std::max(high, trace.hip_position_m[i].y());
  }
  return high - low;
}

bool opens(const Trace& trace, double from_s) {
  for (std::size_t i = 0; i < trace.length(); ++i)
    if (trace.time_s[i] >= from_s && trace.force_N[i].isZero(0)) return true;
  return false;
}

// An oscillation that grows until the hand leaves the surface no longer grows, so a contact that opens counts
// too.
bool is_unstable(const Trace& trace) {
  const double first = swing_m(trace, kWindow_s[0], kWindow_s[1]);
  const double second = swing_m(trace, kWindow_s[1], kWindow_s[2]);
  return (second > kLeastSwing_m && second > first) || opens(trace, kWindow_s[1]);
}

}  // namespace

double linear_wall_N_per_m(double damping_Ns_per_m, int delay_ticks) {
  return damping_Ns_per_m / (kTick_s / 2 + delay_ticks * kTick_s);
}

void bisect(FigureContext& context, const std::vector<WallLimit*>& limits) {
  for (int halving = 0; halving < kHalvings; ++halving) {
    std::vector<Experiment> runs;
    for (const WallLimit* limit : limits) runs.push_back(limit->experiment_(limit->middle_N_per_m()));
    const auto unstable = context.measure(runs, is_unstable);
    for (std::size_t i = 0; i < limits.size(); ++i)
      (unstable[i] ? limits[i]->unstable_N_per_m_ : limits[i]->stable_N_per_m_) = limits[i]->middle_N_per_m();
  }
}

}  // namespace remote_touch
