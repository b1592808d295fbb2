#include "runners/evaluation/figures/studies/carried_limits.h"

#include <algorithm>
#include <cmath>

#include "analysis/theory/surface_contacts.h"
#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/points/vector.h"
#include "runners/experiment/mesh_files/loaded_tool.h"

namespace remote_touch {

std::vector<double> CarrySweep::values(std::size_t axis) const {
  const auto& all = std::get<std::vector<double>>(result_.axes.at(axis).values);
  std::vector<double> of_settings;
  for (std::size_t setting = 0; setting < settings(); ++setting)
    of_settings.push_back(all.at(result_.axis_indices(cell(setting, 0, Carrier::voxels)).at(axis)));
  return of_settings;
}

EventCounts CarrySweep::lost(std::size_t setting, std::size_t strength, Carrier rule) const {
  return event_counts(result_, result_.measure("tool_popped_through"), cell(setting, strength, rule));
}

CarrySweep::Limit CarrySweep::limit(std::size_t setting, Carrier rule) const {
  Limit limit;
  for (std::size_t i = 0; i < strengths().size(); ++i) {
    const EventCounts lost_here = lost(setting, i, rule);
    const bool any = lost_here.events > 0, all = lost_here.known() > 0 && lost_here.without == 0;
    if (any && limit.lost > strengths()[i]) limit.lost = strengths()[i];
    if (strengths()[i] < limit.lost) limit.carried = strengths()[i];
    if (!all)
      limit.all_lost = std::numeric_limits<double>::infinity();
    else if (limit.all_lost > strengths()[i])
      limit.all_lost = strengths()[i];
  }
  return limit;
}

double count_rows_apart(const Table& table, const std::string& carried, const std::string& lost,
                        const std::string& low, const std::string& high) {
  const auto &from = numbers(table, carried), &to = numbers(table, lost), &least = numbers(table, low),
             &most = numbers(table, high);
  double apart = 0;
  for (std::size_t i = 0; i < from.size(); ++i)
    apart += std::isnan(least[i] + most[i]) || to[i] < least[i] || from[i] > most[i];
  return apart;
}

Table derived_table(const Table& limits, const DerivedLimit& derived, int samples) {
  const Column& setting = limits.columns.front();
  const std::vector<double>& settings = numbers(limits, setting.name);
  const double from = settings.front(), step = (settings.back() - from) / (samples - 1);
  std::vector<double> at;
  for (int i = 0; i < samples; ++i) at.push_back(from + i * step);
  Table table{limits.name + "_bounds", limits.title + ": derived limits"};
  table.add(setting.name, setting.units, setting.long_name, at);
  for (const CarrierName& carrier : kCarriers) {
    std::vector<double> bound;
    for (const double value : at) bound.push_back(derived(carrier.rule, value));
    table.add(std::string(carrier.column) + "_bound", limits.columns.at(1).units, "derived limit",
              std::move(bound));
  }
  return table;
}

void add_limit_panel(Figure& figure, const Table& limits, const DerivedLimit& derived,
                     const LimitLabels& labels, const PanelFrame& frame, int derived_samples) {
  const Table bounds = derived_table(limits, derived, derived_samples);
  const std::string x = limits.columns.front().name;
  std::vector<Curve> curves;
  for (const CarrierName& carrier : kCarriers) {
    const std::string column = carrier.column, label = carrier.label, carried = column + "_carried";
    curves.push_back({bounds.name, x, column + "_bound", CurveStyle::dashed, label + ", derived"});
    curves.push_back({limits.name, x, carried, CurveStyle::intervals, "", 0, column + "_first_lost"});
    curves.push_back({limits.name, x, carried, CurveStyle::dots, label});
  }
  figure.tables.push_back(bounds);
  figure.panels.push_back(plot(limits.title, labels.x, labels.y, std::move(curves), frame));
}

namespace {

constexpr double kPlateSpacing_m = 0.0015;

// The surface under a plate that reaches half_m to either side.
using Under = std::function<UnderPlate(double half_m)>;

// Returns the jump that a contact rule allows. The printed rule counts the interior of the plate, 6.2.4.
// Look-ahead counts the whole plate. The continuous rule also counts the way out, along which the highest
// position must become free.
double jump_m(Carrier rule, double thickness_m, const UnderPlate& under) {
  if (rule == Carrier::voxels) return thickness_m - 2 * ToolSettings{}.voxel_m + under.drop_m;
  const double through_m = thickness_m + under.drop_m;
  if (rule == Carrier::look_ahead) return through_m;
  return std::max(through_m, ToolParameters{}.frame_reach_m - under.rise_m);
}

Jump derived(Carrier rule, double thickness_m, const Under& under) {
  const double half_m = kHalfPlate_m - (rule == Carrier::voxels ? ToolSettings{}.voxel_m : 0);
  const double disk_m =
      rule == Carrier::voxels ? ToolSettings{}.voxel_m : ToolParameters{}.disk_radius_ratio * kPlateSpacing_m;
  const double jumps_m[] = {jump_m(rule, thickness_m, under(half_m - kPlateSpacing_m)),
                            jump_m(rule, thickness_m, under(half_m + disk_m))};
  const double bound_m = jump_m(rule, thickness_m, under(half_m));
  return {std::min({jumps_m[0], jumps_m[1], bound_m}), bound_m, std::max({jumps_m[0], jumps_m[1], bound_m})};
}

// Returns all points of the shape: their heights, and the probability that noise leaves or brings them under
// the plate.
std::vector<NoisyPoint> noisy_points(Shape::Kind kind, double half_m, double sigma_m) {
  Shape::Settings settings;
  settings.kind = kind, settings.slope_deg = kSlope_deg, settings.radius_m = kRadius_m;
  const Grid grid{60, 60, kPlateSpacing_m, 0, 0};
  const Shape shape(settings, grid);
  const auto below = [&](double x) { return 0.5 * std::erfc(-x / sigma_m * std::sqrt(0.5)); };
  const auto within = [&](double x) { return below(half_m - x) - below(-half_m - x); };
  std::vector<NoisyPoint> points;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const Vec3 point = shape.point(grid.x(column), grid.z(row));
      if (point.allFinite()) points.push_back({point.y(), within(point.x()) * within(point.z())});
    }
  return points;
}

// Returns the jump after which half of the runs are lost, of a plate whose half width is larger by wider_m.
double noise_jump_m(Carrier rule, Shape::Kind kind, double sigma_m, double wider_m) {
  const double shell_m = rule == Carrier::voxels ? ToolSettings{}.voxel_m : 0;
  const double way_out_m = rule == Carrier::continuous ? ToolParameters{}.frame_reach_m : 0;
  const double half_m = kHalfPlate_m - shell_m + wider_m;
  return std::max(way_out_m,
                  noisy_jump_m(kPlate_m - 2 * shell_m, noisy_points(kind, half_m, sigma_m), sigma_m));
}

}  // namespace

Jump on_edge(Carrier rule, double thickness_m, double slope_deg, double turn_deg) {
  return derived(rule, thickness_m, [&](double half_m) {
    return under_edge(slope_deg * kRadiansPerDegree, half_m, turn_deg * kRadiansPerDegree);
  });
}

// The contact that holds the plate may be one of the faces of a corner. The way out of the continuous rule is
// then along that face's normal.
Jump on_corner(Carrier rule, double thickness_m, double slope_deg) {
  const double slope_rad = slope_deg * kRadiansPerDegree;
  Jump jump = derived(rule, thickness_m, [&](double half_m) { return under_corner(slope_rad, half_m); });
  if (rule == Carrier::continuous)
    jump.least_m = std::max(on_corner(Carrier::look_ahead, thickness_m, slope_deg).least_m,
                            ToolParameters{}.frame_reach_m * std::cos(slope_rad));
  return jump;
}

// The lowest measured points may be a spacing away from the rim of the ball.
Jump on_ball(Carrier rule, double thickness_m, double radius_m) {
  return derived(rule, thickness_m, [&](double half_m) {
    const double seen_m = std::sqrt(2.0) * half_m;
    return under_ball(radius_m, half_m < kHalfPlate_m - kPlateSpacing_m / 2
                                    ? std::min(seen_m, radius_m - kPlateSpacing_m)
                                    : seen_m);
  });
}

Jump on_plane(Carrier rule, double extent_m) {
  return derived(rule, extent_m, [](double) { return UnderPlate{}; });
}

// The smallest and the largest jump are those of a plate that is narrower by a spacing, or wider by a disk,
// as without noise.
Jump on_noise(Carrier rule, Shape::Kind kind, double sigma_m) {
  const double disk_m =
      rule == Carrier::voxels ? ToolSettings{}.voxel_m : ToolParameters{}.disk_radius_ratio * kPlateSpacing_m;
  return {noise_jump_m(rule, kind, sigma_m, -kPlateSpacing_m), noise_bound_m(rule, kind, sigma_m),
          noise_jump_m(rule, kind, sigma_m, disk_m)};
}

double noise_bound_m(Carrier rule, Shape::Kind kind, double sigma_m) {
  return noise_jump_m(rule, kind, sigma_m, 0);
}

}  // namespace remote_touch
