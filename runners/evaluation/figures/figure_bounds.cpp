// The bounds (4.14) to (4.25): their ingredients as measured, and how well they agree with the simulated
// lifts.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "runners/evaluation/figures/pop_through_map.h"

namespace remote_touch {

namespace {

using LiftUpdates = std::vector<LiftUpdate>;
using Effect = NoiseEffect;

LiftUpdates updates_of(const Trace& trace) {
  return lift_updates(trace, Vec3(0, 1, 0), kLift.r1_m, kLift.frame_rate_hz);
}

// (4.19) to (4.24): the effect of noise, from lifts without acceleration, and fits up to kFitted_m.

constexpr double kFitted_m = 0.01;
constexpr SettledFrom kSettled{kRiseFrames + 5};  // the velocity estimate has reached its level

struct MeasuredNoise {
  Numbers sigma_m;
  std::vector<NoiseEffect> effect;  // one for each of sigma_m
  PolynomialFit thickness, normal_error;

  NoiseEffect at(double noise_m) const {  // linear between the measured strengths
    const auto above = std::upper_bound(sigma_m.begin() + 1, sigma_m.end() - 1, noise_m);
    const auto i = static_cast<std::size_t>(above - sigma_m.begin());
    const double t = (noise_m - sigma_m[i - 1]) / (sigma_m[i] - sigma_m[i - 1]);
    Effect between = effect[i - 1];
    for (double Effect::*part :
         {&Effect::thickness_m, &Effect::thickness_sd_m, &Effect::normal_error, &Effect::normal_error_sd,
          &Effect::velocity_bias_m_per_s, &Effect::velocity_sd_m_per_s, &Effect::margin_sd_m, &Effect::gain})
      between.*part += t * (effect[i].*part - between.*part);
    return between;
  }
};

MeasuredNoise measured_noise(FigureContext& context) {
  const Sweep sweep = Sweep::load("steady-lifts");
  const SweepResult plan = sweep.plan();
  const std::vector<LiftUpdates> lifts = context.measure(sweep, updates_of);
  MeasuredNoise noise;
  noise.sigma_m = axis_values(plan, 0);
  Numbers x, thickness, normal_error;
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
  const auto of = [&](double Effect::*part) { return each(noise.effect, part); };
  return {
      "noise_effect",
      "what noise does, measured over lifts without acceleration",
      {{"noise", "r_c", "standard deviation of the noise",
        each(noise.sigma_m, [](double sigma) { return sigma / kContactRadius_m; })},
       {"thickness", "m", "h, mean", of(&Effect::thickness_m)},
       {"thickness_sd", "m", "h, standard deviation", of(&Effect::thickness_sd_m)},
       {"normal_error", "1", "e_n, mean", of(&Effect::normal_error)},
       {"normal_error_sd", "1", "e_n, standard deviation", of(&Effect::normal_error_sd)},
       {"velocity_bias", "m/s", "velocity estimate minus velocity, mean", of(&Effect::velocity_bias_m_per_s)},
       {"velocity_sd", "m/s", "velocity estimate, standard deviation", of(&Effect::velocity_sd_m_per_s)},
       {"margin_sd", "m", "margin of (4.17), standard deviation", of(&Effect::margin_sd_m)},
       {"gain", "1", "share of a velocity error that one update corrects", of(&Effect::gain)}}};
}

// The map of Fig 4.13 with the noise of another seed: every update of every lift, and which lifts survived.
struct LiftMap {
  Table map;  // noise, acceleration, survived
  std::vector<LiftUpdates> updates;
};

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

// Number of updates by whether (4.17) holds and by their outcome: the proxy stays above the plane, or pops
// through. (4.18) is the same criterion, rewritten for a cloud that moves along its normal.
struct Criterion {
  double holds_stays = 0, holds_pops = 0, fails_stays = 0, fails_pops = 0;
  double agreement() const {
    return (holds_stays + fails_pops) / (holds_stays + holds_pops + fails_stays + fails_pops);
  }
};

// Counts the updates of the lifts with noise in [low, high), r_c, during the acceleration, until the proxy is
// below the plane.
Criterion criterion_of(const LiftMap& lifts, double low, double high) {
  const std::vector<double>& noise = numbers(lifts.map, "noise");
  Criterion count;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    if (noise[i] < low || noise[i] >= high) continue;
    for (const LiftUpdate& update : lifts.updates[i]) {
      if (update.frame <= kRiseFrames) continue;
      if (!update.above_before) break;
      if (update.margin_m(kLift.r1_m, kLift.frame_rate_hz) > 0)
        ++(update.above_after ? count.holds_stays : count.holds_pops);
      else
        ++(update.above_after ? count.fails_stays : count.fails_pops);
    }
  }
  return count;
}

Table criterion_table(const LiftMap& lifts) {
  // The first range is noise-free, the others are half an r_c wide. No node of the map lies on an edge.
  constexpr double kEdges[] = {0, 0.01, 0.51, 1.01, 1.51, 2.01, 2.51, 3.01};
  TableRows rows;
  for (std::size_t i = 0; i + 1 < std::size(kEdges); ++i) {
    const Criterion c = criterion_of(lifts, kEdges[i], kEdges[i + 1]);
    rows.push_back({kEdges[i], c.holds_stays, c.holds_pops, c.fails_stays, c.fails_pops, c.agreement()});
  }
  return table_of("criterion", "(4.17) at each of the ten updates of every lift, and what happened",
                  {{"noise_from", "r_c", "lower edge of the range of noise"},
                   {"holds_and_stays", "1", "(4.17) holds and the proxy stays above"},
                   {"holds_but_pops", "1", "(4.17) holds but the proxy pops through"},
                   {"fails_but_stays", "1", "(4.17) does not hold but the proxy stays above"},
                   {"fails_and_pops", "1", "(4.17) does not hold and the proxy pops through"},
                   {"agreement", "1", "share in which they agree"}},
                  rows);
}

// A bound as a function of the noise, m/s^2. It keeps a reference to the MeasuredNoise it was made from.
struct AccelerationBound {
  std::string name, meaning;
  std::function<double(double noise_m)> at;
  double max_noise_m = 1;  // the curve ends here: fits are not valid beyond it
};

std::vector<AccelerationBound> bounds(const MeasuredNoise& noise) {
  const auto bound = [](const auto& thickness, const auto& normal_error, double noise_m, double less) {
    return bound_acceleration(kLift, thickness.at(noise_m) - less, normal_error.at(noise_m));
  };
  const auto refitted = [=, &noise](double noise_m, double less) {
    return bound(noise.thickness, noise.normal_error, noise_m, less);
  };
  // Error of the predicted surface height over one frame if the velocity estimate is off by one standard
  // deviation.
  const auto deviation = [&noise](double noise_m) {
    return noise.at(noise_m).velocity_sd_m_per_s / kLift.frame_rate_hz;
  };
  return {{"printed", "(4.25) as printed", printed_bound},
          {"printed_less", "(4.25) as printed, less one deviation of v_hat",
           [=](double s) { return bound(printed_thickness(), printed_normal_error(), s, deviation(s)); }},
          {"refitted", "(4.25) refitted", [=](double s) { return refitted(s, 0); }, kFitted_m},
          {"refitted_less", "(4.25) refitted, less one deviation of v_hat",
           [=](double s) { return refitted(s, deviation(s)); }, kFitted_m},
          {"scatter", "with scatter, ten updates",
           [&noise](double s) { return scatter_bound(kLift, noise.at(s)); }}};
}

// Agreement over the cells with noise up to a limit (r_c).
struct Agreement {
  int cells = 0, agree = 0;
  double safe_popped = 0, unsafe_survived = 0;  // fractions of the bound's safe and unsafe cells
  double fraction() const { return static_cast<double>(agree) / cells; }
};

Agreement agreement_of(const AccelerationBound& bound, const Table& map, double max_noise) {
  const auto &noise = numbers(map, "noise"), &acceleration = numbers(map, "acceleration"),
             &survived = numbers(map, "survived");
  std::map<double, double> limit;
  for (const double x : noise) limit.try_emplace(x, bound.at(x * kContactRadius_m) / kContactRadius_m);
  int cells = 0, safe = 0, safe_popped = 0, unsafe_survived = 0;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    if (noise[i] > max_noise || std::isnan(limit[noise[i]])) continue;
    const bool is_safe = acceleration[i] < limit[noise[i]];
    const bool stays = survived[i] > 0.5;
    ++cells, safe += is_safe ? 1 : 0;
    safe_popped += is_safe && !stays ? 1 : 0;
    unsafe_survived += !is_safe && stays ? 1 : 0;
  }
  return {cells, cells - safe_popped - unsafe_survived, static_cast<double>(safe_popped) / safe,
          static_cast<double>(unsafe_survived) / (cells - safe)};
}

std::vector<Agreement> agreements(const std::vector<AccelerationBound>& bounds, const Table& map,
                                  double max_noise) {
  return list_of(bounds, [&](const AccelerationBound& bound) { return agreement_of(bound, map, max_noise); });
}

// all, fitted: the agreement over all cells, and over those with noise for which the fits are valid.
Table agreement_table(const std::vector<AccelerationBound>& bounds, const std::vector<Agreement>& all,
                      const std::vector<Agreement>& fitted) {
  std::vector<std::int32_t> number(bounds.size());
  std::iota(number.begin(), number.end(), 0);
  const auto names = list_of(bounds, [](const AccelerationBound& bound) { return bound.name; });
  using A = const Agreement&;
  return {"agreement",
          "bounds against the outcome of 5396 lifts",
          {{"bound", "1", "which bound", number, 1, names},
           {"cells", "1", "share of cells in which bound and outcome agree", each(all, &Agreement::fraction)},
           {"cells_low", "1", "lower end of its 95 % interval",
            each(all, [](A a) { return exact_interval(a.agree, a.cells).first; })},
           {"cells_high", "1", "upper end of its 95 % interval",
            each(all, [](A a) { return exact_interval(a.agree, a.cells).second; })},
           {"safe_popped", "1", "share of the bound's safe cells that popped through",
            each(all, &Agreement::safe_popped)},
           {"unsafe_survived", "1", "share of the bound's unsafe cells that survived",
            each(all, &Agreement::unsafe_survived)},
           {"fitted_cells", "1", "share that agrees up to 2 r_c of noise, where the fits are meant",
            each(fitted, &Agreement::fraction)},
           {"fitted_safe_popped", "1", "share of the safe cells there that popped through",
            each(fitted, &Agreement::safe_popped)}}};
}

// The ranges of noise: suffix of the columns, words for readers.
constexpr std::pair<const char*, const char*> kNoiseRanges[] = {
    {"to_1_rc", "noise to r_c"}, {"to_2_rc", "r_c to 2 r_c"}, {"to_3_rc", "2 r_c to 3 r_c"}};

// Returns predicted and observed survival, by ranges of both noise and prediction. Columns have the suffix of
// the range of noise.
Table calibration_table(const MeasuredNoise& noise, const Table& map) {
  constexpr std::size_t kRanges = std::size(kNoiseRanges), kBins = 10;
  struct Bin {
    double predicted = 0, observed = 0, cells = 0;  // sums
  };
  std::array<Bin, kBins> bins[kRanges];
  const auto &x = numbers(map, "noise"), &acceleration = numbers(map, "acceleration"),
             &survived = numbers(map, "survived");
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double p =
        survival_probability(kLift, noise.at(x[i] * kContactRadius_m), acceleration[i] * kContactRadius_m);
    if (std::isnan(p)) continue;
    Bin& bin = bins[std::min(kRanges - 1, static_cast<std::size_t>(x[i]))]
                   [std::min(kBins - 1, static_cast<std::size_t>(kBins * p))];
    bin.predicted += p, bin.observed += survived[i], ++bin.cells;
  }
  // A bin without cells has 0 / 0, NaN.
  const auto end = [](const Bin& b, bool is_high) {
    const auto [low, high] = exact_interval(b.observed, b.cells);
    return b.cells == 0 ? kNoValue : is_high ? high : low;
  };
  Table table{"calibration", "survival as the bound with scatter predicts it, and as observed"};
  for (std::size_t range = 0; range < kRanges; ++range) {
    const auto add = [&](const std::string& column, const std::string& meaning, const auto& value) {
      table.add(column + kNoiseRanges[range].first, "1", meaning, each(bins[range], value));
    };
    add("predicted_", "mean prediction of the cells", [](const Bin& b) { return b.predicted / b.cells; });
    add("observed_", "share of them that survived", [](const Bin& b) { return b.observed / b.cells; });
    add("observed_low_", "lower end of its 95 % interval", [&](const Bin& b) { return end(b, false); });
    add("observed_high_", "upper end of its 95 % interval", [&](const Bin& b) { return end(b, true); });
    add("cells_", "cells", &Bin::cells);
  }
  return table;
}

// Returns a refitted curve and the printed one, each with its band, over the noise for which the fits are
// valid.
Table fit_table(const std::string& name, const std::string& unit, const PolynomialFit& fit,
                const PrintedFit& printed) {
  TableRows rows;
  for (int i = 0; i <= 100; ++i) {
    const double sigma = kFitted_m * i / 100, value = fit.at(sigma), print = printed.at(sigma);
    const double half_width = fit.half_width(sigma), digits = printed.digits_band(sigma);
    rows.push_back({sigma / kContactRadius_m, value, value - half_width, value + half_width, print,
                    print - digits, print + digits});
  }
  return table_of(name, "least-square fit, refitted and printed",
                  {kNoiseColumn,
                   {"refitted", unit, "refitted"},
                   {"refitted_low", unit, "lower end of its 95 % confidence band"},
                   {"refitted_high", unit, "upper end of its 95 % confidence band"},
                   {"printed", unit, "as printed"},
                   {"printed_low", unit, "lower end of what the printed digits allow"},
                   {"printed_high", unit, "upper end of what the printed digits allow"}},
                  rows);
}

Table coefficient_table(const std::string& name, const PolynomialFit& fit, const PrintedFit& printed) {
  const std::size_t count = fit.powers.size();
  return {name,
          "coefficients of the fit",
          {{"power", "1", "power of sigma in metres", doubles(fit.powers)},
           {"printed", "SI", "as printed", printed.coefficients},
           {"refitted", "SI", "refitted", fit.coefficients},
           {"standard_error", "SI", "standard error of the refitted coefficient",
            each_of(count, [&](std::size_t k) { return std::sqrt(fit.covariance[k * count + k]); })}}};
}

// The line on which two shares are equal.
Table equal_table() {
  const Numbers shares = each_of(41, [](std::size_t i) { return static_cast<double>(i) / 40.0; });
  return {"equal",
          "observed as predicted",
          {{"predicted", "1", "predicted share", shares}, {"observed", "1", "observed share", shares}}};
}

Panel calibration_panel() {
  const std::pair<double, double> shares{-0.02, 1.02};
  Panel panel = plot("Survival: predicted with scatter, and observed", "predicted", "observed",
                     {{"equal", "predicted", "observed", CurveStyle::dashed, "equal"}},
                     {.x_range = shares, .y_range = shares, .equal_aspect = true});
  for (const auto& [suffix, label] : kNoiseRanges) {
    const std::string range = suffix, predicted = "predicted_" + range;
    panel.curves.push_back({"calibration", predicted, "observed_low_" + range, CurveStyle::intervals, "", 0,
                            "observed_high_" + range});
    panel.curves.push_back({"calibration", predicted, "observed_" + range, CurveStyle::dots, label});
  }
  return panel;
}

Table bound_table(const std::vector<AccelerationBound>& bounds) {
  Table table = noise_table("bounds", "bounds on pop-through");
  for (const AccelerationBound& bound : bounds)
    add_bound(table, bound.name, bound.meaning, [&](double noise_m) {
      const bool is_meant = noise_m <= bound.max_noise_m * (1 + 1e-9);
      return is_meant ? bound.at(noise_m) : kNoValue;
    });
  return table;
}

Panel fit_panel(const std::string& table, const std::string& title, const std::string& label) {
  return plot(
      title, "noise (r_c)", label,
      {{table, "noise", "printed_low", CurveStyle::band, "what the printed digits allow", 0, "printed_high"},
       {table, "noise", "printed", CurveStyle::dashed, "printed"},
       {table, "noise", "refitted_low", CurveStyle::band, "95 % confidence", 0, "refitted_high"},
       {table, "noise", "refitted", CurveStyle::line, "refitted"}});
}

std::vector<Panel> panels(const std::vector<AccelerationBound>& bounds) {
  Panel map = survivor_panel("Bounds over the map", "survived", false);
  for (const AccelerationBound& bound : bounds)
    map.curves.push_back({"bounds", "noise", bound.name,
                          bound.name.ends_with("_less") ? CurveStyle::dashed : CurveStyle::line,
                          bound.meaning});
  return {fit_panel("thickness_fit", "Thickness of the cloud (4.23)", "h (m)"),
          fit_panel("normal_error_fit", "Error of the normal (4.24)", "e_n"),
          plot("Velocity estimate", "noise (r_c)", "error of v_hat (m/s)",
               {{"noise_effect", "noise", "velocity_bias", CurveStyle::dots, "mean error of v_hat"},
                {"noise_effect", "noise", "velocity_sd", CurveStyle::dots, "its standard deviation"}}),
          map, calibration_panel()};
}

// (4.19), v_hat = v, is checked over lifts at 0.1 m/s. It holds without noise. With noise, the first step
// after a frame leads out of the outermost points, and the later steps let the proxy sink back between them.
// (4.13) does not count the later steps. At a constant velocity the mean motion in a frame is v / f_c, so
// v_hat is too high by f_c times the mean depth by which the proxy sinks back. The range is 4 standard errors
// of the mean over 2800 updates: 0.106 m/s / 53, times 1.8 because errors of successive updates are
// correlated by 0.53.
void add_estimate_claims(const Claims& claims, const MeasuredNoise& noise) {
  constexpr double kKnown = 0.154, kStandardError = 0.0037, kRounding = 1e-9;
  const double bias = noise.at(kFitted_m).velocity_bias_m_per_s;
  claims.at_most("without noise v_hat is the velocity of a surface at 0.1 m/s: mean error",
                 std::abs(noise.at(0).velocity_bias_m_per_s), kRounding, "m/s", "v_hat = v (4.19)");
  claims.differs("with noise of 2 r_c v_hat is too large for a surface at 0.1 m/s: mean error", bias,
                 kKnown - 4 * kStandardError, kKnown + 4 * kStandardError, "m/s",
                 "\"very good\", v_hat = v (4.19)");
}

// survived_low, survived_high: at kSurvives and kPops.
void add_claims(Figure& figure, double survived_low, double survived_high, const Table& phases,
                const Table& thickness, const Table& normal_error, const Criterion& criterion,
                const Agreement& printed, const Agreement& with_scatter) {
  const auto &survives = numbers(phases, "survives"), &pops = numbers(phases, "pops");
  // The proxy sinks up to 0.113 mm in the middle of four points, and rests within 0.01 mm of r_c; r_1 is 0.01
  // mm less. The bisection ends 0.0001 wide.
  constexpr double kMinRatio = 1 - (0.113 + 0.01) / 4.99, kMaxRatio = 1 + (0.01 + 0.01) / 4.99;
  const Claims claims(figure), map_claims(figure, "", &Claim::of_map);
  claims.at_least(
      "without noise, no lift with 4.3 m/s^2 pops through: fraction of 64 grid phases that do not",
      survived_low, 1, "fraction", "a < 4.491 (4.14)");
  claims.at_most(
      "without noise, every lift with 4.6 m/s^2 pops through: fraction of 64 grid phases that do not",
      survived_high, 0, "fraction", "a < 4.491 (4.14)");
  claims.between(
      "without noise the critical acceleration is that of (4.14): smallest ratio over the grid phases",
      min_of(survives) / critical_acceleration(kLift), kMinRatio, kMaxRatio, "1", "1 (4.14)");
  claims.between(
      "without noise the critical acceleration is that of (4.14): largest ratio over the grid phases",
      max_of(pops) / critical_acceleration(kLift), kMinRatio, kMaxRatio, "1", "1 (4.14)");
  claims.at_most("the refitted thickness follows (4.23) for noise up to 2 r_c: rms difference",
                 rms(minus(numbers(thickness, "refitted"), numbers(thickness, "printed"))), 3e-4, "m",
                 "(4.23)");
  claims.between(
      "the refitted normal error at 2 r_c is within what the printed digits of (4.24) allow: its value",
      numbers(normal_error, "refitted").back(), numbers(normal_error, "printed_low").back(),
      numbers(normal_error, "printed_high").back(), "1", "0.26 from rounded digits");
  claims.differs("(4.24) as printed gives a larger normal error at 2 r_c than the refit: ratio",
                 numbers(normal_error, "printed").back() / numbers(normal_error, "refitted").back(), 2, 3.5,
                 "1", "1");
  map_claims.at_least("(4.17) predicts most pop-throughs at their update: fraction of them",
                      criterion.fails_pops / (criterion.fails_pops + criterion.holds_pops), 0.7, "fraction",
                      "exact if all were known");
  map_claims.at_least("(4.17) holds at nearly all updates without pop-through: fraction of them",
                      criterion.holds_stays / (criterion.holds_stays + criterion.fails_stays), 0.98,
                      "fraction", "exact if all were known");
  map_claims.between("(4.25) as printed predicts the outcome in most cells of the map: fraction of them",
                     printed.fraction(), 0.75, 0.85, "fraction", "a bit loose");
  map_claims.at_least(
      "the bound with scatter predicts the outcome in most cells of the map: fraction of them",
      with_scatter.fraction(), 0.87, "fraction");
  map_claims.at_most(
      "few lifts pop through in cells that the bound with scatter calls safe: fraction that do",
      with_scatter.safe_popped, 0.15, "fraction");
}

}  // namespace

Figure figure_bounds(FigureContext& context) {
  constexpr double kAllNoise = 4, kFittedNoise = kFitted_m / kContactRadius_m + 0.01;  // r_c
  constexpr int kSeed = 2;  // the bound with scatter was derived while a map of another seed was viewed
  const double survived_low = survived_over_phases(context, 8, kSurvives),
               survived_high = survived_over_phases(context, 8, kPops);
  const Table phases = critical_over_phases(context);
  const MeasuredNoise noise = measured_noise(context);
  const LiftMap lifts = lift_map(context, kSeed);
  const Criterion criterion = criterion_of(lifts, 0, kAllNoise);
  const std::vector<AccelerationBound> list = bounds(noise);
  const std::vector<Agreement> agreed = agreements(list, lifts.map, kAllNoise);
  const Table thickness = fit_table("thickness_fit", "m", noise.thickness, printed_thickness());
  const Table normal_error = fit_table("normal_error_fit", "1", noise.normal_error, printed_normal_error());
  Figure figure{
      "bounds", "Bounds on pop-through",
      "What the bounds of 4.4 are made of, measured over lifts without acceleration, beside the printed "
      "fits; and the bounds over 5396 lifts with fresh noise. In the map, (4.25) refitted is above the shown "
      "range from 1.2 r_c to 2 r_c, where its fits end. Less one deviation of v_hat: h is reduced by the "
      "distance that one standard deviation of v_hat makes in a frame. With scatter, ten updates: the "
      "acceleration at which half of the lifts are predicted to survive all ten updates, from the scatter "
      "that was measured without acceleration. Last panel: the share of the lifts that survived, with exact "
      "95 % intervals, over the share that the bound with scatter predicts."};
  figure.tables = {phases,
                   effect_table(noise),
                   thickness,
                   normal_error,
                   coefficient_table("thickness_coefficients", noise.thickness, printed_thickness()),
                   coefficient_table("normal_error_coefficients", noise.normal_error, printed_normal_error()),
                   criterion_table(lifts),
                   lifts.map,
                   survivors("survived", lifts.map),
                   bound_table(list),
                   agreement_table(list, agreed, agreements(list, lifts.map, kFittedNoise)),
                   calibration_table(noise, lifts.map),
                   equal_table()};
  figure.panels = panels(list);
  add_claims(figure, survived_low, survived_high, phases, thickness, normal_error, criterion, agreed.front(),
             agreed.back());
  add_estimate_claims(Claims(figure), noise);
  return figure;
}

}  // namespace remote_touch
