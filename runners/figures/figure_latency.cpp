// How far a fixture is violated when its frames come late, at irregular times or not at all: what chapter 8
// names and does not measure.
#include <algorithm>
#include <cmath>
#include <limits>

#include "runners/figures/figures.h"

namespace remote_touch {

namespace {

// Of the experiments late-surface and late-heart.
constexpr double kFixtureRadius_m = 0.02, kContactRadius_m = 0.005, kFrameRate_hz = 30;
constexpr double kSpeed_m_per_s = 0.1, kLatency_s = 0.05;
// By then an estimate of the velocity has settled.
constexpr double kSettled_s = 1.5;

// How deep the contact point of the slave, sent to the proxy, is at most inside the region of the surface as
// it is at that moment.
struct Violation {
  double largest_m = 0;  // of the whole run
  double settled_m = 0;  // of its last part
};

Violation violation(const Trace& trace) {
  double least = std::numeric_limits<double>::infinity(), settled = least;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    const double distance = trace.slave_distance_m[i];
    least = std::min(least, distance);
    if (trace.time_s[i] >= kSettled_s) settled = std::min(settled, distance);
  }
  return {kFixtureRadius_m + kContactRadius_m - least, kFixtureRadius_m + kContactRadius_m - settled};
}

// A frame shows the surface as it was; until the next one comes it is older by a frame's interval.
double predicted_m(double speed_m_per_s, double latency_s) {
  return speed_m_per_s * (latency_s + 1 / kFrameRate_hz);
}

std::vector<Violation> measure(const Laboratory& laboratory, const std::string& sweep, bool prediction) {
  // Frames get older here than the default lets a prediction be trusted.
  std::vector<std::string> set = {"renderer.longest_prediction_s=0.4"};
  if (prediction) set.push_back("renderer.slave_prediction=true");
  return laboratory.measure(Sweep::load(sweep, set), violation);
}

// Values of an axis of a stored sweep, one for each run.
std::vector<double> axis_of_runs(const std::string& sweep, std::size_t axis) {
  const SweepResult plan = Sweep::load(sweep).plan();
  const auto& values = std::get<std::vector<double>>(plan.axes.at(axis).values);
  std::vector<double> list;
  for (std::size_t run = 0; run < plan.run_count(); ++run)
    list.push_back(values[plan.place(plan.cell_of(run))[axis]]);
  return list;
}

std::vector<double> times(const std::vector<double>& values, double factor) {
  std::vector<double> list;
  for (const double value : values) list.push_back(factor * value);
  return list;
}

Table map_table(const std::vector<Violation>& plain, const std::vector<Violation>& ahead) {
  const auto latency = axis_of_runs("fixture-latency", 0), speed = axis_of_runs("fixture-latency", 1);
  std::vector<double> measured, predicted, settled;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    measured.push_back(1e3 * plain[i].largest_m), settled.push_back(1e3 * ahead[i].settled_m);
    predicted.push_back(1e3 * predicted_m(speed[i], latency[i]));
  }
  Table table{"delay_and_speed", "violation of a fixture on a surface that rises evenly"};
  table.add("latency", "ms", "from capture to arrival", times(latency, 1e3));
  table.add("speed", "m/s", "of the surface", speed);
  table.add("violation", "mm", "largest depth of the slave in the region", measured);
  table.add("predicted", "mm", "speed times (latency + one frame interval)", predicted);
  table.add("with_prediction", "mm", "depth with the slave sent ahead, from 1.5 s on", settled);
  return table;
}

// The delays at which the prediction reaches the surface that the fixture is to protect.
Table tissue_table() {
  Table table{"tissue", "where the slave reaches the surface itself"};
  std::vector<double> latency, speed;
  for (int ms = 67; ms <= 200; ++ms) {
    latency.push_back(ms);
    speed.push_back(kFixtureRadius_m / (1e-3 * ms + 1 / kFrameRate_hz));
  }
  table.add("latency", "ms", "from capture to arrival", latency);
  table.add("speed", "m/s", "of the surface", speed);
  return table;
}

// Replicates as mean and largest; one row for each value of the only axis.
Table spread_table(const std::string& sweep, const std::string& axis, const std::string& unit, double scale,
                   const std::vector<Violation>& plain, const std::vector<Violation>& ahead) {
  const SweepResult plan = Sweep::load(sweep).plan();
  const auto replicates = static_cast<std::size_t>(plan.replicates);
  std::vector<double> place, mean, largest, mean_ahead;
  for (std::size_t cell = 0; cell < plan.cell_count(); ++cell) {
    double sum = 0, sum_ahead = 0, most = 0;
    for (std::size_t run = cell * replicates; run < (cell + 1) * replicates; ++run) {
      sum += plain[run].largest_m, sum_ahead += ahead[run].settled_m;
      most = std::max(most, plain[run].largest_m);
    }
    place.push_back(scale * std::get<std::vector<double>>(plan.axes[0].values)[cell]);
    mean.push_back(1e3 * sum / plan.replicates), largest.push_back(1e3 * most);
    mean_ahead.push_back(1e3 * sum_ahead / plan.replicates);
  }
  Table table{axis, "violation over 20 runs"};
  table.add(axis, unit, plan.axes[0].long_name, place);
  table.add("mean", "mm", "mean of the runs' largest depths", mean);
  table.add("largest", "mm", "largest of them", largest);
  table.add("with_prediction", "mm", "mean with the slave sent ahead, from 1.5 s on", mean_ahead);
  return table;
}

void add_jitter_bounds(Table& table) {
  std::vector<double> lowest, highest;
  for (const double jitter_ms : numbers(table, "jitter")) {
    lowest.push_back(1e3 * predicted_m(kSpeed_m_per_s, kLatency_s));
    highest.push_back(1e3 * predicted_m(kSpeed_m_per_s, kLatency_s + 1e-3 * jitter_ms));
  }
  table.add("all_early", "mm", "speed times (latency + one interval)", lowest);
  table.add("all_late", "mm", "speed times (latency + jitter + one interval)", highest);
}

// One row for each delay, one column for each heart rate.
Table heart_table(const std::vector<Violation>& plain, const std::vector<Violation>& ahead) {
  const SweepResult plan = Sweep::load("heart-latency").plan();
  const auto& rates = std::get<std::vector<double>>(plan.axes[1].values);
  Table table{"heart", "violation of a fixture on a beating heart"};
  table.add("latency", "ms", "from capture to arrival",
            times(std::get<std::vector<double>>(plan.axes[0].values), 1e3));
  for (std::size_t k = 0; k < rates.size(); ++k) {
    std::vector<double> measured, predicted;
    for (std::size_t cell = k; cell < plan.cell_count(); cell += rates.size())
      measured.push_back(1e3 * plain[cell].largest_m), predicted.push_back(1e3 * ahead[cell].settled_m);
    const std::string name = "rate_" + std::to_string(static_cast<int>(rates[k]));
    table.add(name, "mm", "largest depth of the slave in the region", measured);
    table.add(name + "_ahead", "mm", "with the slave sent ahead, from 1.5 s on", predicted);
  }
  return table;
}

Panel depth_panel(const std::string& title, const std::string& x_label, std::vector<Curve> curves) {
  return {title, x_label, "depth in the region (mm)", false, std::move(curves)};
}

std::vector<Panel> panels() {
  Panel map{"Violation by delay and speed",
            "latency (ms)",
            "speed of the surface (m/s)",
            false,
            {{"delay_and_speed", "latency", "speed", CurveStyle::map, "", 0, "violation"},
             {"tissue", "latency", "speed", CurveStyle::line, "predicted to reach the surface"}}};
  map.y_range = std::pair(-0.005, 0.205);
  std::vector<Panel> list = {
      map,
      depth_panel("Irregular delay, 0.1 m/s, 50 ms", "jitter (ms)",
                  {{"jitter", "jitter", "all_early", CurveStyle::band, "bounds", 0, "all_late"},
                   {"jitter", "jitter", "largest", CurveStyle::dots, "largest of 20 runs"},
                   {"jitter", "jitter", "mean", CurveStyle::line, "mean"},
                   {"jitter", "jitter", "with_prediction", CurveStyle::dashed, "slave sent ahead, settled"}}),
      depth_panel("Lost frames, 0.1 m/s, 50 ms", "share of frames lost",
                  {{"drops", "drops", "largest", CurveStyle::dots, "largest of 20 runs"},
                   {"drops", "drops", "mean", CurveStyle::line, "mean"},
                   {"drops", "drops", "with_prediction", CurveStyle::dashed, "slave sent ahead, settled"}}),
      depth_panel("Beating heart, sensor noise", "latency (ms)", {})};
  for (const char* rate : {"40", "75", "120"}) {
    const std::string column = std::string("rate_") + rate;
    list[3].curves.push_back(
        {"heart", "latency", column, CurveStyle::line, std::string(rate) + " beats per minute"});
    list[3].curves.push_back(
        {"heart", "latency", column + "_ahead", CurveStyle::dashed, "slave sent ahead, settled"});
  }
  for (std::size_t i = 0; i < list.size(); ++i)
    list[i].place = std::pair(static_cast<double>(i / 2), static_cast<double>(i % 2));
  return list;
}

// In the cells where the predicted violation is below the limit.
template <class Error>
double largest_error(const Table& map, double limit_mm, Error&& error) {
  const auto& predicted = numbers(map, "predicted");
  double largest = 0;
  for (std::size_t i = 0; i < predicted.size(); ++i)
    if (predicted[i] < limit_mm) largest = std::max(largest, error(i));
  return largest;
}

double share_told(const Table& map) {
  const auto &measured = numbers(map, "violation"), &predicted = numbers(map, "predicted");
  double agree = 0;
  for (std::size_t i = 0; i < measured.size(); ++i)
    agree += (measured[i] > 1e3 * kFixtureRadius_m) == (predicted[i] > 1e3 * kFixtureRadius_m) ? 1 : 0;
  return agree / static_cast<double>(measured.size());
}

// How far outside its bounds any jittered run is.
double largest_outside(const Table& jitter) {
  double largest = 0;
  for (std::size_t i = 0; i < numbers(jitter, "largest").size(); ++i)
    largest = std::max({largest, numbers(jitter, "largest")[i] - numbers(jitter, "all_late")[i],
                        numbers(jitter, "all_early")[i] - numbers(jitter, "mean")[i]});
  return largest;
}

}  // namespace

Figure figure_latency(const Laboratory& laboratory) {
  const auto plain = [&](const char* sweep) { return measure(laboratory, sweep, false); };
  const auto ahead = [&](const char* sweep) { return measure(laboratory, sweep, true); };
  const Table map = map_table(plain("fixture-latency"), ahead("fixture-latency"));
  Table jitter =
      spread_table("fixture-jitter", "jitter", "ms", 1e3, plain("fixture-jitter"), ahead("fixture-jitter"));
  add_jitter_bounds(jitter);
  const Table drops =
      spread_table("fixture-drops", "drops", "1", 1, plain("fixture-drops"), ahead("fixture-drops"));
  const Table heart = heart_table(plain("heart-latency"), ahead("heart-latency"));
  const auto &violation = numbers(map, "violation"), &predicted = numbers(map, "predicted"),
             &settled = numbers(map, "with_prediction");

  Figure figure{
      "latency",
      "Fixtures from late frames",
      "A surface with r_f = 0.02 m rises evenly against a pressing HIP, and frames arrive late; "
      "simulated. Depth: how far the slave's contact point, sent to the proxy, is inside the region "
      "of the surface where it is at that moment. It is the way that the surface makes in the delay "
      "and one frame interval; the correction (4.3) does not change that. At 20 mm the surface "
      "itself is reached. Dashed: the slave is sent ahead of the proxy by the velocity estimate "
      "times the age of the frame, which is not in the dissertation; once the estimate has settled.",
      {map, tissue_table(), jitter, drops, heart},
      panels()};
  figure.claims = {
      claim_at_most(
          "latency", "violation against speed x (latency + frame interval), where that is below r_f", "-",
          largest_error(map, 20, [&](std::size_t i) { return std::abs(violation[i] - predicted[i]); }), 0.2,
          "mm"),
      claim_at_least("latency", "cells in which the same rule tells whether the slave reaches the surface",
                     "-", share_told(map), 0.99, "share"),
      claim_at_most("latency", "violation with the slave sent ahead, settled, where it was below r_f", "-",
                    largest_error(map, 20, [&](std::size_t i) { return settled[i]; }), 0.5, "mm"),
      claim_at_most("latency", "jittered runs: how far outside the bounds for all early and all late", "-",
                    largest_outside(jitter), 0.2, "mm"),
      claim_at_least("latency", "lost frames: mean violation at a loss of 0.3 over that at 0", "-",
                     numbers(drops, "mean")[6] / numbers(drops, "mean")[0], 1.5, "1"),
  };
  return figure;
}

}  // namespace remote_touch
