// The bounds (4.14) to (4.25): their ingredients as measured, and how well they agree with the simulated
// lifts.
#include <cmath>

#include "analysis/trace/interval_estimates.h"
#include "runners/evaluation/figures/parts/pop_through_map.h"

namespace remote_touch {

namespace {

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
  TableRows rows;
  for (std::size_t k = 0; k < fit.powers.size(); ++k)
    rows.push_back({static_cast<double>(fit.powers[k]), printed.coefficients[k], fit.coefficients[k],
                    std::sqrt(fit.covariance[k * fit.powers.size() + k])});
  return table_of(name, "coefficients of the fit",
                  {{"power", "1", "power of sigma in metres"},
                   {"printed", "SI", "as printed"},
                   {"refitted", "SI", "refitted"},
                   {"standard_error", "SI", "standard error of the refitted coefficient"}},
                  rows);
}

// Returns the rms difference of the refitted and the printed curve, over the noise of fit_table().
double rms_from_print(const Table& fit) {
  const auto &refitted = numbers(fit, "refitted"), &printed = numbers(fit, "printed");
  double squares = 0;
  for (std::size_t i = 0; i < refitted.size(); ++i) squares += std::pow(refitted[i] - printed[i], 2);
  return std::sqrt(squares / static_cast<double>(refitted.size()));
}

// The line on which two shares are equal.
Table equal_table() {
  TableRows rows;
  for (int i = 0; i <= 40; ++i) rows.push_back({i / 40.0, i / 40.0});
  return table_of("equal", "observed as predicted",
                  {{"predicted", "1", "predicted share"}, {"observed", "1", "observed share"}}, rows);
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

void add_claims(Figure& figure, const Phases& phases, const Table& thickness, const Table& normal_error,
                const Criterion& criterion, const std::vector<AccelerationBound>& bounds, const Table& map) {
  const auto &survives = numbers(phases.table, "survives"), &pops = numbers(phases.table, "pops");
  // The proxy sinks up to 0.113 mm in the middle of four points, and rests within 0.01 mm of r_c; r_1 is 0.01
  // mm less. The bisection ends 0.0001 wide.
  constexpr double kMinRatio = 1 - (0.113 + 0.01) / 4.99, kMaxRatio = 1 + (0.01 + 0.01) / 4.99;
  const Claims claims(figure), map_claims(figure, "", &Claim::of_map);
  claims.at_least(
      "without noise, no lift with 4.3 m/s^2 pops through: fraction of 64 grid phases that do not",
      phases.survived_low, 1, "fraction", "a < 4.491 (4.14)");
  claims.at_most(
      "without noise, every lift with 4.6 m/s^2 pops through: fraction of 64 grid phases that do not",
      phases.survived_high, 0, "fraction", "a < 4.491 (4.14)");
  claims.between(
      "without noise the critical acceleration is that of (4.14): smallest ratio over the grid phases",
      min_of(survives) / critical_acceleration(kLift), kMinRatio, kMaxRatio, "1", "1 (4.14)");
  claims.between(
      "without noise the critical acceleration is that of (4.14): largest ratio over the grid phases",
      max_of(pops) / critical_acceleration(kLift), kMinRatio, kMaxRatio, "1", "1 (4.14)");
  claims.at_most("the refitted thickness follows (4.23) for noise up to 2 r_c: rms difference",
                 rms_from_print(thickness), 3e-4, "m", "(4.23)");
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
                     agreement_of(bounds.front(), map).fraction(), 0.75, 0.85, "fraction", "a bit loose");
  map_claims.at_least(
      "the bound with scatter predicts the outcome in most cells of the map: fraction of them",
      agreement_of(bounds.back(), map).fraction(), 0.87, "fraction");
  map_claims.at_most(
      "few lifts pop through in cells that the bound with scatter calls safe: fraction that do",
      agreement_of(bounds.back(), map).safe_popped, 0.15, "fraction");
}

}  // namespace

Figure figure_bounds(FigureContext& context) {
  constexpr int kSeed = 2;  // the bound with scatter was derived while a map of another seed was viewed
  const Phases phases = critical_over_phases(context);
  const MeasuredNoise noise = measured_noise(context);
  const LiftMap lifts = lift_map(context, kSeed);
  const Criterion criterion = criterion_of(lifts, 0, 4);
  const std::vector<AccelerationBound> list = bounds(noise);
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
  figure.tables = {phases.table,
                   effect_table(noise),
                   thickness,
                   normal_error,
                   coefficient_table("thickness_coefficients", noise.thickness, printed_thickness()),
                   coefficient_table("normal_error_coefficients", noise.normal_error, printed_normal_error()),
                   criterion_table(lifts),
                   lifts.map,
                   survivors("survived", lifts.map),
                   bound_table(list),
                   agreement_table(list, lifts.map),
                   calibration_table(noise, lifts.map),
                   equal_table()};
  figure.panels = panels(list);
  add_claims(figure, phases, thickness, normal_error, criterion, list, lifts.map);
  add_estimate_claims(Claims(figure), noise);
  return figure;
}

}  // namespace remote_touch
