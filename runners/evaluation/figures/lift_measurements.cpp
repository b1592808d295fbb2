#include "runners/evaluation/figures/lift_measurements.h"

#include <algorithm>
#include <cmath>

#include "analysis/measures/measures.h"
#include "analysis/statistics/means_and_extremes.h"
#include "runners/evaluation/figures/pop_through_map.h"

namespace remote_touch {

namespace {

// Updates in which the velocity estimate has reached its level.
constexpr SettledFrom kSettled{kRiseFrames + 5};

// Returns the position of the grid below the proxy, in units of its spacing. step: 0 to 7.
double phase_of(std::size_t step) {
  return 0.125 * static_cast<double>(step);
}

LiftUpdates updates_of(const Trace& trace) {
  return lift_updates(trace, Vec3(0, 1, 0), kLift.r1_m, kLift.frame_rate_hz);
}

std::vector<double> popped_over_phases(FigureContext& context, const std::vector<double>& acceleration) {
  std::vector<Experiment> lifts;
  for (std::size_t i = 0; i < acceleration.size(); ++i)
    lifts.push_back(Experiment::load(
        "fig4.12",
        {"scenario.noise_sigma_m=0", "scenario.acceleration_m_per_s2=" + std::to_string(acceleration[i]),
         "scenario.phase_x=" + std::to_string(phase_of(i / 8)),
         "scenario.phase_z=" + std::to_string(phase_of(i % 8))}));
  return known_pop_throughs(context, lifts);
}

}  // namespace

Phases critical_over_phases(FigureContext& context) {
  constexpr std::size_t kCount = 64;
  Phases phases;
  std::vector<double> low(kCount, Phases::kSurvives), high(kCount, Phases::kPops), middle(kCount), x, z;
  phases.survived_low = 1 - mean(popped_over_phases(context, low));
  phases.survived_high = 1 - mean(popped_over_phases(context, high));
  for (int halving = 0; halving < 10; ++halving) {
    for (std::size_t i = 0; i < kCount; ++i) middle[i] = 0.5 * (low[i] + high[i]);
    const std::vector<double> popped = popped_over_phases(context, middle);
    for (std::size_t i = 0; i < kCount; ++i) (popped[i] > 0.5 ? high : low)[i] = middle[i];
  }
  for (std::size_t i = 0; i < kCount; ++i) x.push_back(phase_of(i / 8)), z.push_back(phase_of(i % 8));
  phases.table.add("phase_x", "1", "shift of the grid in units of its spacing", x);
  phases.table.add("phase_z", "1", "shift of the grid in units of its spacing", z);
  phases.table.add("survives", "m/s^2", "largest acceleration tried without pop-through", low);
  phases.table.add("pops", "m/s^2", "smallest acceleration tried with pop-through", high);
  return phases;
}

NoiseEffect MeasuredNoise::at(double noise_m) const {
  const auto above = std::upper_bound(sigma_m.begin() + 1, sigma_m.end() - 1, noise_m);
  const auto i = static_cast<std::size_t>(above - sigma_m.begin());
  const double t = (noise_m - sigma_m[i - 1]) / (sigma_m[i] - sigma_m[i - 1]);
  const auto between = [&](double NoiseEffect::*part) {
    return effect[i - 1].*part + t * (effect[i].*part - effect[i - 1].*part);
  };
  return {between(&NoiseEffect::thickness_m),           between(&NoiseEffect::thickness_sd_m),
          between(&NoiseEffect::normal_error),          between(&NoiseEffect::normal_error_sd),
          between(&NoiseEffect::velocity_bias_m_per_s), between(&NoiseEffect::velocity_sd_m_per_s),
          between(&NoiseEffect::margin_sd_m),           between(&NoiseEffect::gain)};
}

MeasuredNoise measured_noise(FigureContext& context) {
  const Sweep sweep = Sweep::load("steady-lifts");
  const SweepResult plan = sweep.plan();
  const std::vector<LiftUpdates> lifts = context.measure(sweep, updates_of);
  MeasuredNoise noise;
  noise.sigma_m = axis_values(plan, 0);
  std::vector<double> x, thickness, normal_error;
  for (std::size_t cell = 0; cell < noise.sigma_m.size(); ++cell) {
    const auto first = lifts.begin() + static_cast<std::ptrdiff_t>(plan.run(cell, 0));
    const std::vector<LiftUpdates> of_cell(first, first + plan.replicates);
    noise.effect.push_back(noise_effect(of_cell, kSettled, kLift.r1_m, kLift.frame_rate_hz));
    if (noise.sigma_m[cell] > kFitted_m * (1 + 1e-9)) continue;
    for (const LiftUpdates& lift : of_cell) {
      const LiftMeans means = lift_means(lift, kSettled);
      if (std::isnan(means.thickness_m)) continue;
      x.push_back(noise.sigma_m[cell]);
      thickness.push_back(means.thickness_m), normal_error.push_back(means.normal_error);
    }
  }
  noise.thickness = fit_polynomial(x, thickness, printed_thickness().powers);
  noise.normal_error = fit_polynomial(x, normal_error, printed_normal_error().powers);
  return noise;
}

Table effect_table(const MeasuredNoise& noise) {
  Table table{"noise_effect", "what noise does, measured over lifts without acceleration"};
  std::vector<double> strengths;
  for (const double sigma : noise.sigma_m) strengths.push_back(sigma / kContactRadius_m);
  table.add("noise", "r_c", "standard deviation of the noise", strengths);
  add_columns<NoiseEffect>(
      table, noise.effect,
      {{"thickness", "m", "h, mean", &NoiseEffect::thickness_m},
       {"thickness_sd", "m", "h, standard deviation", &NoiseEffect::thickness_sd_m},
       {"normal_error", "1", "e_n, mean", &NoiseEffect::normal_error},
       {"normal_error_sd", "1", "e_n, standard deviation", &NoiseEffect::normal_error_sd},
       {"velocity_bias", "m/s", "velocity estimate minus velocity, mean",
        &NoiseEffect::velocity_bias_m_per_s},
       {"velocity_sd", "m/s", "velocity estimate, standard deviation", &NoiseEffect::velocity_sd_m_per_s},
       {"margin_sd", "m", "margin of (4.17), standard deviation", &NoiseEffect::margin_sd_m},
       {"gain", "1", "share of a velocity error that one update corrects", &NoiseEffect::gain}});
  return table;
}

LiftMap lift_map(FigureContext& context, int seed) {
  const Sweep sweep = context.map("fig4.13", {seed_setting(seed)});
  const SweepResult plan = sweep.plan();
  LiftMap result;
  result.updates = context.measure(sweep, updates_of);
  TableRows rows;
  for (std::size_t cell = 0; cell < plan.cell_count(); ++cell)
    rows.push_back({axis_value(plan, 0, cell) / kContactRadius_m,
                    axis_value(plan, 1, cell) / kContactRadius_m,
                    result.updates[cell].back().above_after ? 1.0 : 0.0});
  result.map = table_of(
      "map", "lifts that did not pop through",
      {kNoiseColumn, kAccelerationColumn, {"survived", "1", "1 when the lift did not pop through"}}, rows);
  return result;
}

}  // namespace remote_touch
