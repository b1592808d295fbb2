#include "runners/evaluation/figures/sensors/sensor_tables.h"

#include <cmath>
#include <utility>

#include "analysis/statistics/curve_fits.h"

namespace remote_touch {

namespace {

constexpr double kFlatShare = 0.25;
constexpr double kFirstJump_per_m = 0.2, kJumpBin_per_m = 0.1;
constexpr int kShown_px = 40;
constexpr std::size_t kFewestWidths = 4;

}  // namespace

double MeasuredSensor::over_time_m(const SensorSource& source, std::size_t range, double share) const {
  return noise_quantile((comparison.*source.statistics).over_time, shown.bounds_m[range],
                        shown.bounds_m[range + 1], share)
      .in_m();
}

DepthNoise MeasuredSensor::about_planes(const SensorSource& source, std::size_t range) const {
  return noise_quantile((comparison.*source.statistics).about_planes, shown.bounds_m[range],
                        shown.bounds_m[range + 1], kFlatShare);
}

std::vector<DepthEdge> MeasuredSensor::shown_edges(const SensorSource& source, bool is_left_of_near) const {
  return edges_between((comparison.*source.statistics).edges, is_left_of_near, shown.edge_low_per_m,
                       shown.edge_high_per_m);
}

std::string side_name(bool is_left_of_near) {
  return is_left_of_near ? "left" : "right";
}

Table noise_table(const MeasuredSensor& sensor) {
  Table table{sensor.table("noise"), sensor.shown.title + ": noise and steps over distance"};
  const auto add = [&](const std::string& name, const std::string& units, const std::string& long_name,
                       auto&& value) {
    std::vector<double> values;
    for (std::size_t range = 0; range < sensor.ranges(); ++range) values.push_back(value(range));
    table.add(name, units, long_name, std::move(values));
  };
  const std::vector<double>& bounds_m = sensor.shown.bounds_m;
  add("depth", "m", "middle of the range of depth",
      [&](std::size_t range) { return 0.5 * (bounds_m[range] + bounds_m[range + 1]); });
  const double px_m = sensor.comparison.focal_px * sensor.comparison.baseline_m;
  for (const SensorSource* source : kSensorSources) {
    const std::string column = source->column, of = std::string(", ") + source->label;
    const bool is_at_rest = sensor.shown.compared.is_at_rest;
    if (is_at_rest)
      add("time_" + column, "m", "median standard deviation of a pixel's depth over time" + of,
          [&](std::size_t range) { return sensor.over_time_m(*source, range); });
    if (is_at_rest)
      add("loud_" + column, "m", "standard deviation that 90 % of the pixels do not exceed" + of,
          [&](std::size_t range) { return sensor.over_time_m(*source, range, kLoudShare); });
    add("planes_" + column, "m", "rms of depth about the plane of a window, lower quartile" + of,
        [&](std::size_t range) { return sensor.about_planes_m(*source, range); });
    add("planes_px_" + column, "px", "rms of disparity about the plane of a window, lower quartile" + of,
        [&](std::size_t range) { return sensor.about_planes(*source, range).per_m * px_m; });
    add("step_" + column, "m", "step of depth" + of, [&](std::size_t range) {
      const double middle_m = 0.5 * (bounds_m[range] + bounds_m[range + 1]);
      return depth_step_per_m((sensor.comparison.*source->statistics).frames, bounds_m[range],
                              bounds_m[range + 1]) *
             middle_m * middle_m;
    });
  }
  return table;
}

// Returns the medians of the widths of holes, over jumps.
Table width_table(const MeasuredSensor& sensor) {
  Table table{sensor.table("widths"), sensor.shown.title + ": width of the holes at depth edges"};
  std::vector<double> lows, jumps;
  for (double low = kFirstJump_per_m; low < sensor.shown.last_jump_per_m - 1e-9; low += kJumpBin_per_m)
    lows.push_back(low), jumps.push_back(low + 0.5 * kJumpBin_per_m);
  table.add("jump", "1/m", "jump of inverse depth at the edge", jumps);
  for (const bool is_left : kEdgeSides)
    for (const SensorSource* source : kSensorSources) {
      std::vector<double> widths;
      for (const double low : lows)
        widths.push_back(median_hole_px(edges_between((sensor.comparison.*source->statistics).edges, is_left,
                                                      low, low + kJumpBin_per_m)));
      table.add(side_name(is_left) + "_" + source->column, "px",
                "median width of holes, " + side_name(is_left) + " of near surfaces, " + source->label,
                widths);
    }
  return table;
}

// Returns how much the holes widen with the jump, as the length of a baseline. NaN if too few widths are
// known.
double shadow_baseline_m(const Table& widths, const std::string& column, double focal_px) {
  std::vector<double> x, y;
  const std::vector<double>&jumps = numbers(widths, "jump"), &widths_px = numbers(widths, column);
  for (std::size_t i = 0; i < jumps.size(); ++i)
    if (!std::isnan(widths_px[i])) x.push_back(jumps[i]), y.push_back(widths_px[i]);
  return x.size() < kFewestWidths ? kNoValue : fit_polynomial(x, y, {0, 1}).coefficients[1] / focal_px;
}

Table hole_table(const MeasuredSensor& sensor) {
  Table table{sensor.table("holes"),
              sensor.shown.title + ": holes beside edges with a jump of 0.4 to 0.7 per m"};
  std::vector<double> distances;
  for (int distance = 1; distance <= kShown_px; ++distance) distances.push_back(distance);
  table.add("distance", "px", "distance from the last pixel of the nearer surface", distances);
  for (const bool is_left : kEdgeSides)
    for (const SensorSource* source : kSensorSources) {
      const std::vector<DepthEdge> edges = sensor.shown_edges(*source, is_left);
      std::vector<double> fractions;
      for (int distance = 1; distance <= kShown_px; ++distance)
        fractions.push_back(hole_fraction(edges, distance));
      table.add(side_name(is_left) + "_" + source->column, "1",
                "fraction of holes, " + side_name(is_left) + " of near surfaces, " + source->label,
                fractions);
    }
  return table;
}

Table truth_table(const TrueObjectErrors& errors) {
  Table table{"truth", "Active stereo: depth minus the depth of true objects"};
  const auto add = [&](const std::string& name, const std::string& units, const std::string& long_name,
                       auto&& value) {
    std::vector<double> values;
    for (const FrameErrors& frame : errors.frames) values.push_back(value(frame));
    table.add(name, units, long_name, std::move(values));
  };
  add("frame", "1", "frame of the recording", [](const FrameErrors& frame) { return frame.frame; });
  for (std::size_t k = 0; k < errors.objects.size(); ++k)
    for (const auto& side :
         {std::pair("recorded", &FrameErrors::recorded), std::pair("simulated", &FrameErrors::simulated)}) {
      const std::string source = side.first;
      const auto of = side.second;
      const std::string column = errors.objects[k] + "_" + source, words = errors.objects[k] + ", " + source;
      add("median_" + column, "m", "median error of depth on the " + words,
          [&](const FrameErrors& frame) { return (frame.*of)[k].median_m; });
      add("spread_" + column, "m", "standard deviation of the error of depth on the " + words,
          [&](const FrameErrors& frame) { return (frame.*of)[k].spread_m; });
      add("measured_" + column, "1", "share of the pixels with a depth on the " + words,
          [&](const FrameErrors& frame) { return (frame.*of)[k].measured; });
    }
  return table;
}

}  // namespace remote_touch
