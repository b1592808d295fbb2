// The study of 1e7 lifts: from which acceleration on they pop through, over spacing, speed and noise, and the
// law that follows.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "analysis/sweeps/sweep_tally.h"
#include "analysis/trace/interval_estimates.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/studies/stored_study.h"
#include "runners/sweep/stored_sweep.h"

namespace remote_touch {

namespace {

constexpr const char* kName = "pop-through-law";
constexpr std::size_t kSpeed = 1;   // 0.1 m/s as in Fig 4.12: for curves and law
constexpr std::size_t kMiddle = 1;  // spacing of Fig 4.12, 1.5 mm

struct Study {
  SweepTally tally;
  LawAxes axes;
  std::vector<LawLimit> half, few;  // limits at which 50 % and 5 % have popped through

  double share(std::size_t cell) const {
    const EventCounts counted = event_counts(tally, 0, cell);
    return static_cast<double>(counted.events) / static_cast<double>(counted.known());
  }
};

Study study_of(SweepTally tally) {
  Study study{std::move(tally), {}, {}, {}};
  study.axes = law_axes(study.tally);
  const CellCounts counts{[&](std::size_t cell) { return event_counts(study.tally, 0, cell); }};
  study.half = law_limits(study.tally, counts, 0.5);
  study.few = law_limits(study.tally, counts, 0.05);
  return study;
}

std::string two_digits(double value) {
  char text[16];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

const std::vector<ColumnName> kLimitColumns = {
    {"noise", "r_c", "standard deviation of the noise"},
    {"limit", "r_c f_c^2", "acceleration at which this share of the lifts pops through"},
    {"low", "r_c f_c^2", "lower end of its 95 % interval"},
    {"high", "r_c f_c^2", "upper end of its 95 % interval"},
    {"law", "r_c f_c^2", "the law for the half"}};

// Returns the limits at one spacing and speed over noise.
Table limit_table(const std::string& name, const std::string& title, const Study& study,
                  const std::vector<LawLimit>& limits, std::size_t spacing, std::size_t speed,
                  const PopThroughLaw& law) {
  TableRows rows;
  for (const LawLimit& each : limits)
    if (each.spacing == spacing && each.speed == speed)
      rows.push_back({study.axes.noise[each.noise], each.limit, each.low, each.high,
                      law.limit(study.axes.spacing[spacing], study.axes.noise[each.noise])});
  return table_of(name, title, kLimitColumns, rows);
}

// Adds a panel with the limits of each spacing; with_law: also the law as lines.
void add_spacings(Figure& figure, const Study& study, const std::vector<LawLimit>& limits,
                  const std::string& share, const PopThroughLaw& law, bool with_law) {
  std::vector<Curve> curves;
  for (std::size_t i = 0; i < study.axes.spacing.size(); ++i) {
    const std::string spacing = two_digits(study.axes.spacing[i]);
    const std::string name = "share_" + share + "_spacing_" + std::to_string(i);
    figure.tables.push_back(limit_table(name, "limits of " + share + " % at a spacing of " + spacing + " r_c",
                                        study, limits, i, kSpeed, law));
    curves.push_back({name, "noise", "limit", CurveStyle::dots, "spacing " + spacing + " r_c"});
    if (with_law) curves.push_back({name, "noise", "law", CurveStyle::line});
  }
  figure.panels.push_back(plot(share + " % pop through" + (with_law ? " (dots), the law (lines)" : ""),
                               "noise (r_c)", "acceleration (r_c f_c^2)", std::move(curves),
                               {.y_range = {{0, 1.7}}}));
}

void add_speeds(Figure& figure, const Study& study, const PopThroughLaw& law) {
  std::vector<Curve> curves;
  for (std::size_t i = 0; i < study.axes.speed.size(); ++i) {
    const std::string speed = two_digits(study.axes.speed[i]), name = "speed_" + std::to_string(i);
    figure.tables.push_back(limit_table(name, "limits of 50 % with a start at " + speed + " r_c f_c", study,
                                        study.half, kMiddle, i, law));
    curves.push_back({name, "noise", "limit", CurveStyle::dots, "start at " + speed + " r_c f_c"});
  }
  figure.panels.push_back(plot("50 % pop through, spacing 0.3 r_c", "noise (r_c)", "acceleration (r_c f_c^2)",
                               std::move(curves), {.y_range = {{0, 1.7}}}));
}

// Adds the share of lifts that pop through over noise and acceleration, as a map.
void add_map(Figure& figure, const Study& study, std::size_t spacing) {
  const std::string name = "map_spacing_" + std::to_string(spacing);
  TableRows rows;
  for (std::size_t n = 0; n < study.axes.noise.size(); ++n)
    for (std::size_t a = 0; a < study.axes.acceleration.size(); ++a)
      rows.push_back({study.axes.noise[n], study.axes.acceleration[a],
                      study.share(study.tally.cell_at({spacing, kSpeed, n, a}))});
  const std::string title = "spacing " + two_digits(study.axes.spacing[spacing]) + " r_c";
  figure.tables.push_back(table_of(name, "share of lifts that pop through, " + title,
                                   {{"noise", "r_c", "standard deviation of the noise"},
                                    {"acceleration", "r_c f_c^2", "acceleration of the lift"},
                                    {"popped_through", "1", "share of lifts that pop through"}},
                                   rows));
  figure.panels.push_back(plot(
      "Share that pops through, " + title, "noise (r_c)", "acceleration (r_c f_c^2)",
      {{name, "noise", "acceleration", CurveStyle::map, "share that pops through", 0, "popped_through"}}));
}

Table law_table(const PopThroughLaw& law, const PopThroughLaw& of_three) {
  return table_of("law", "limit / (r_c f_c^2) = (1 - s^2 / 2)^(1/2) + (gain - loss s) sigma",
                  {{"spacings", "1", "number of spacings whose limits were fitted"},
                   {"gain", "1", "what noise gains at dense points"},
                   {"loss", "1", "what noise loses for each r_c of spacing"},
                   {"neutral_spacing", "r_c", "spacing at which noise does not change the limit"}},
                  {{5, law.gain, law.loss, law.neutral_spacing()},
                   {3, of_three.gain, of_three.loss, of_three.neutral_spacing()}});
}

// Returns the number of cells whose lifts, all made again, do not pop through as often as in the tally.
int different_cells(FigureContext& context, const Study& study, const Sweep& sweep) {
  const std::array<std::array<std::size_t, 4>, 3> chosen = {{{0, 1, 19, 20}, {2, 0, 7, 11}, {4, 3, 3, 2}}};
  int different = 0;
  for (const auto& indices : chosen) {
    const std::size_t cell = study.tally.cell_at({indices.begin(), indices.end()});
    std::vector<std::uint64_t> runs;
    for (int i = 0; i < study.tally.replicates; ++i) runs.push_back(study.tally.run(cell, i));
    const std::vector<double> popped = context.part(sweep, std::move(runs)).measure("popped_through");
    const auto events = std::count(popped.begin(), popped.end(), 1.0);
    different += events != event_counts(study.tally, 0, cell).events;
  }
  return different;
}

// Returns the largest difference between the limits with the 30 steps of the dissertation and those of the
// study, at the spacing and the speed of Fig 4.12 and three strengths of noise.
double difference_to_30_steps(FigureContext& context, const Study& study, const std::string& config) {
  const SweepResult lifts = context.sweep(Sweep::from_json(
      config, kName,
      {"keep=runs", "replicates=40", "renderer.steps_per_tick=30", "renderer.gamma=0.3",
       R"(axes.0={"parameter": "scenario.spacing_m", "values": [0.0015]})", "scenario.start_depth_m=0.02",
       R"(axes.1={"parameter": "scenario.start_velocity_m_per_s", "values": [0.1]})",
       R"(axes.2={"parameter": "scenario.noise_sigma_m", "values": [0.0005, 0.0025, 0.005]})"}));
  const CellCounts counts{
      [&](std::size_t cell) { return event_counts(lifts, lifts.measure("popped_through"), cell); }};
  const LawAxes axes = law_axes(lifts);
  std::vector<double> differences;
  for (const LawLimit& each : law_limits(lifts, counts, 0.5))
    for (const LawLimit& ours : study.half)
      if (ours.spacing == kMiddle && ours.speed == kSpeed &&
          std::abs(study.axes.noise[ours.noise] - axes.noise[each.noise]) < 1e-9)
        differences.push_back(std::abs(ours.limit - each.limit));
  return differences.size() == axes.noise.size() ? max_of(differences) : std::nan("");
}

double limit_at(const Study& study, std::size_t spacing, std::size_t speed, std::size_t noise) {
  for (const LawLimit& each : study.half)
    if (each.spacing == spacing && each.speed == speed && each.noise == noise) return each.limit;
  return std::nan("");
}

// Returns the root mean square of the differences of the known limits at two speeds.
double apart(const Study& study, std::size_t one, std::size_t other) {
  std::vector<double> squares;
  for (std::size_t s = 0; s < study.axes.spacing.size(); ++s)
    for (std::size_t n = 0; n < study.axes.noise.size(); ++n) {
      const double difference = limit_at(study, s, one, n) - limit_at(study, s, other, n);
      if (std::isfinite(difference)) squares.push_back(difference * difference);
    }
  return std::sqrt(mean(squares));
}

// Returns the largest difference between the limits at the least noise and those without noise.
double away_without_noise(const Study& study) {
  return max_where(
      study.axes.spacing.size(), [](std::size_t) { return true; },
      [&](std::size_t i) {
        return std::abs(limit_at(study, i, kSpeed, 0) - PopThroughLaw::without_noise(study.axes.spacing[i]));
      });
}

void add_claims(Figure& figure, const Study& study, const PopThroughLaw& law, const PopThroughLaw& of_three,
                double to_30_steps) {
  const Claims claims(figure);
  const std::size_t last_noise = study.axes.noise.size() - 1, widest = study.axes.spacing.size() - 1;
  claims.at_most(
      "with noise of 0.05 r_c half of the lifts pop through at e f_c^2, where e is the height of the proxy "
      "amid four points: largest difference over five spacings",
      away_without_noise(study), 0.1, "r_c f_c^2", "0 (4.14)");
  claims.at_most("a law with two fitted numbers gives the limits over spacing and noise: rms residual",
                 rms_residual(law, points_at(study.axes, study.half, kSpeed, {0, 1, 2, 3, 4})), 0.06,
                 "r_c f_c^2");
  claims.at_most("the law of three spacings predicts the limits at the two between them: rms residual",
                 rms_residual(of_three, points_at(study.axes, study.half, kSpeed, {1, 3})), 0.07,
                 "r_c f_c^2");
  claims.between("noise raises the limit of dense points and lowers that of sparse ones: neutral spacing",
                 law.neutral_spacing(), 0.33, 0.43, "r_c");
  claims.at_least("with points 0.2 r_c apart noise of r_c raises the limit: by",
                  limit_at(study, 0, kSpeed, last_noise) - limit_at(study, 0, kSpeed, 0), 0.4, "r_c f_c^2");
  claims.at_most("with points 0.6 r_c apart noise of 0.75 r_c lowers the limit: change",
                 limit_at(study, widest, kSpeed, 14) - limit_at(study, widest, kSpeed, 0), -0.4, "r_c f_c^2");
  claims.at_most("a start at 0.33 or 0.67 r_c f_c gives the same limits: rms difference",
                 apart(study, 0, kSpeed), 0.09, "r_c f_c^2");
  claims.at_least(
      "a start above r_c f_c with points 0.3 r_c apart and noise of 0.05 r_c is lost at the first touch: "
      "share that pops through at the least acceleration",
      study.share(study.tally.cell_at({kMiddle, 3, 0, 0})), 0.5, "fraction");
  claims.at_most("30 steps of gamma = 0.3 give the limits of 8 steps of 0.5: largest difference of three",
                 to_30_steps, 0.1, "r_c f_c^2");
}

void add_checks(FigureContext& context, Figure& figure, const Study& study, const Sweep& sweep) {
  const Claims checks(figure, "", &Claim::set_up);
  checks.between("the tally has every run of the sweep: runs", static_cast<double>(study.tally.held.count()),
                 1e7, 1e7, "runs");
  checks.at_most("3000 runs of three cells are made again and counted: cells with another count",
                 different_cells(context, study, sweep), 0, "cells");
}

}  // namespace

Figure figure_pop_through_law(FigureContext& context) {
  const StoredTally stored = stored_study(kName);
  const std::string config = attribute(stored.attributes, "config");
  const Sweep sweep = Sweep::from_json(config, kName);
  const Study study = study_of(stored.tally);
  const PopThroughLaw law = fitted_law(points_at(study.axes, study.half, kSpeed, {0, 1, 2, 3, 4})),
                      of_three = fitted_law(points_at(study.axes, study.half, kSpeed, {0, 2, 4}));
  Figure figure{
      kName, "The law of pop-through",
      "1e7 lifts of noisy clouds, a stored tally: the acceleration at which the proxy of half of them, "
      "and of 5 %, passes to the wrong side within six frames, over the noise, for five spacings of "
      "the points and four speeds at the start. r_c: contact radius, f_c: frame rate. Start at 0.67 "
      "r_c f_c unless stated; simulated."};
  figure.source = "this project";
  add_spacings(figure, study, study.half, "50", law, true);
  add_spacings(figure, study, study.few, "5", law, false);
  add_map(figure, study, 0);
  add_map(figure, study, study.axes.spacing.size() - 1);
  add_speeds(figure, study, law);
  place_in_rows(figure, 2);
  figure.tables.push_back(law_table(law, of_three));
  add_claims(figure, study, law, of_three, difference_to_30_steps(context, study, config));
  add_checks(context, figure, study, sweep);
  return figure;
}

}  // namespace remote_touch
