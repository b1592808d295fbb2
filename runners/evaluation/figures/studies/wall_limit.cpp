#include "runners/evaluation/figures/studies/wall_limit.h"

#include <algorithm>
#include <string>

#include "analysis/trace/interval_estimates.h"
#include "core/points/vector.h"

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

namespace {

constexpr double kNoisyDamping_Ns_per_m = 2, kNoisyMass_kg = 0.3, kNoisyFrame_s = 1.0 / 30;
constexpr SampledWall kNoisyWall{.mass_kg = kNoisyMass_kg, .damping_Ns_per_m = kNoisyDamping_Ns_per_m};
constexpr double kAtRest_s = 1.6;  // time from which the hand rests
constexpr double kSoft_N_per_m = 200;
constexpr int kNoiseSeeds = 4, kNoiseHalvings = 7;

// A proxy that does not estimate a velocity moves only when a frame arrives.
Experiment noisy_hand(double noise_m, double stiffness_N_per_m, int seed) {
  return Experiment::load(
      "virtual-wall",
      {R"(scenario={"name": "moving-shape", "columns": 60, "rows": 60, "rise_s": 7.9})",
       "scenario.noise_sigma_m=" + std::to_string(noise_m), "renderer.velocity_estimate=false",
       "renderer.stiffness_N_per_m=" + std::to_string(stiffness_N_per_m),
       "operator.mass_kg=" + std::to_string(kNoisyMass_kg),
       "operator.stiffness_N_per_m=" + std::to_string(stiffness_N_per_m / 4),
       "device.damping_Ns_per_m=" + std::to_string(kNoisyDamping_Ns_per_m), "duration_s=8",
       "seed=" + std::to_string(seed)});
}

// Variance of the values of the ticks at rest.
template <class Value>
double variance_at_rest(const Trace& trace, const Value& value) {
  std::vector<double> values;
  for (std::size_t i = 0; i < trace.length(); ++i)
    if (trace.time_s[i] >= kAtRest_s) values.push_back(value(i));
  return moments_of(values).variance;
}

double variance_of_hand_m2(const Trace& trace) {
  return variance_at_rest(trace, [&](std::size_t i) { return trace.hip_position_m[i].y(); });
}

// The plane is where the force would be zero.
double variance_of_plane_m2(const Trace& trace) {
  return variance_at_rest(trace, [&](std::size_t i) {
    return trace.hip_position_m[i].y() + trace.force_N[i].y() / kSoft_N_per_m;
  });
}

// Returns the mean over the seeds of a variance, for the hand on each wall with the given stiffness.
template <class Stiffness>
std::vector<double> mean_variances(FigureContext& context, const std::vector<NoisyWall>& walls,
                                   const Stiffness& stiffness_N_per_m, double (*variance)(const Trace&)) {
  std::vector<Experiment> runs;
  for (std::size_t i = 0; i < walls.size(); ++i)
    for (int seed = 1; seed <= kNoiseSeeds; ++seed)
      runs.push_back(noisy_hand(walls[i].noise_m, stiffness_N_per_m(i), seed));
  const std::vector<double> all = context.measure(runs, variance);
  std::vector<double> means;
  for (auto next = all.begin(); next != all.end(); next += kNoiseSeeds)
    means.push_back(mean(std::vector<double>(next, next + kNoiseSeeds)));
  return means;
}

double expected_variance_m2(double plane_noise_m, double stiffness_N_per_m) {
  const double half = std::sqrt(1.25 * stiffness_N_per_m / kNoisyMass_kg) * kNoisyFrame_s / 2;
  const double q = std::sin(half) / half;
  const double damping = kNoisyDamping_Ns_per_m * (1 - stiffness_N_per_m / wall_law_N_per_m(kNoisyWall));
  return plane_noise_m * plane_noise_m * stiffness_N_per_m * kNoisyFrame_s * q * q / (2.5 * damping);
}

// Returns the stiffness up to which is_calm(stiffness), between two of which it is true for the first only.
template <class IsCalm>
double last_calm(double calm, double not_calm, int halvings, const IsCalm& is_calm) {
  for (int i = 0; i < halvings; ++i) {
    const double middle = std::sqrt(calm * not_calm);
    (is_calm(middle) ? calm : not_calm) = middle;
  }
  return std::sqrt(calm * not_calm);
}

}  // namespace

std::vector<NoisyWall> noisy_walls(FigureContext& context, const std::vector<double>& noise_m) {
  constexpr double kMost_m2 = NoisyWall::kCalm_m * NoisyWall::kCalm_m;
  std::vector<NoisyWall> walls;
  for (const double each_m : noise_m) walls.push_back({each_m});
  const std::vector<double> plane_m2 = mean_variances(
      context, walls, [](std::size_t) { return kSoft_N_per_m; }, variance_of_plane_m2);
  std::vector<double> calm, not_calm;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    NoisyWall& wall = walls[i];
    wall.plane_noise_m = std::sqrt(plane_m2[i]);
    wall.expected_N_per_m = last_calm(1, wall_law_N_per_m(kNoisyWall), 40, [&](double stiffness) {
      return expected_variance_m2(wall.plane_noise_m, stiffness) <= kMost_m2;
    });
    calm.push_back(0.4 * wall.expected_N_per_m), not_calm.push_back(2.5 * wall.expected_N_per_m);
  }
  const auto middle = [&](std::size_t i) { return std::sqrt(calm[i] * not_calm[i]); };
  for (int halving = 0; halving < kNoiseHalvings; ++halving) {
    const std::vector<double> hand_m2 = mean_variances(context, walls, middle, variance_of_hand_m2);
    for (std::size_t i = 0; i < walls.size(); ++i)
      (hand_m2[i] <= kMost_m2 ? calm[i] : not_calm[i]) = middle(i);
  }
  for (std::size_t i = 0; i < walls.size(); ++i) walls[i].stiffness_N_per_m = middle(i);
  return walls;
}

}  // namespace remote_touch
