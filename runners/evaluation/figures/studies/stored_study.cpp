#include "runners/evaluation/figures/studies/stored_study.h"

#include <algorithm>
#include <cmath>

#include "core/parameters/parameter.h"

namespace remote_touch {

StoredTally stored_study(const std::string& name) {
  const auto all = embedded_studies();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const EmbeddedFile& file) { return file.name == name; });
  if (found == all.end()) throw InputError(name, "no such study: expected a file of data/studies");
  StoredTally study = read_tally(Hdf5Reader(name, open_hdf5_image(found->bytes)));
  require_trusted(name, study.attributes);
  return study;
}

namespace {

constexpr std::size_t kAccelerations = 3;  // number of the axis

std::vector<double> in_units(const Column& axis, const std::string& name, double unit) {
  const auto* values = std::get_if<std::vector<double>>(&axis.values);
  if (axis.name != name || !values)
    throw InputError(axis.name, "an axis of a study of pop-through: expected " + name);
  std::vector<double> numbers;
  for (const double value : *values) numbers.push_back(value / unit);
  return numbers;
}

}  // namespace

LawAxes law_axes(const SweepGrid& grid) {
  if (grid.axes.size() != 4) throw InputError("a study of pop-through", "expected four axes");
  const double speed = kLawRadius_m * kLawRate_hz, acceleration = speed * kLawRate_hz;
  return {in_units(grid.axes[0], "spacing_m", kLawRadius_m),
          in_units(grid.axes[1], "start_velocity_m_per_s", speed),
          in_units(grid.axes[2], "noise_sigma_m", kLawRadius_m),
          in_units(grid.axes[kAccelerations], "acceleration_m_per_s2", acceleration)};
}

std::vector<LawLimit> law_limits(const SweepGrid& grid, const CellCounts& events, double level) {
  const LawAxes axes = law_axes(grid);
  // The lifts of a cell are independent, and cells share no noise.
  const Table table = event_limits(grid, events, {"popped_through", 0.5, kAccelerations, level, true},
                                   independent_streams(grid.cell_count()))
                          .table;
  const auto &limit = numbers(table, "value"), &low = numbers(table, "low"), &high = numbers(table, "high");
  const double unit = kLawRadius_m * kLawRate_hz * kLawRate_hz;
  std::vector<LawLimit> limits;
  for (std::size_t row = 0; row < limit.size(); ++row) {
    const std::size_t of_speed = row / axes.noise.size();
    limits.push_back({of_speed / axes.speed.size(), of_speed % axes.speed.size(), row % axes.noise.size(),
                      limit[row] / unit, low[row] / unit, high[row] / unit});
  }
  return limits;
}

std::vector<LimitPoint> points_at(const LawAxes& axes, const std::vector<LawLimit>& limits, std::size_t speed,
                                  const std::vector<std::size_t>& spacings) {
  std::vector<LimitPoint> points;
  for (const LawLimit& each : limits)
    for (const std::size_t spacing : spacings)
      if (each.speed == speed && each.spacing == spacing && std::isfinite(each.limit))
        points.push_back({axes.spacing[each.spacing], axes.noise[each.noise], each.limit});
  return points;
}

}  // namespace remote_touch
