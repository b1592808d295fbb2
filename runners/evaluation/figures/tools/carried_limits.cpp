#include "runners/evaluation/figures/tools/carried_limits.h"

#include <cmath>

namespace remote_touch {

std::vector<double> CarrySweep::values(std::size_t axis) const {
  const auto& all = std::get<std::vector<double>>(result_.axes.at(axis).values);
  std::vector<double> of_settings;
  for (std::size_t setting = 0; setting < settings(); ++setting)
    of_settings.push_back(all.at(result_.axis_indices(cell(setting, 0, Carrier::voxels)).at(axis)));
  return of_settings;
}

Tally CarrySweep::lost(std::size_t setting, std::size_t strength, Carrier rule) const {
  return tally(result_, result_.measure("tool_popped_through"), cell(setting, strength, rule));
}

CarrySweep::Limit CarrySweep::limit(std::size_t setting, Carrier rule) const {
  Limit limit;
  for (std::size_t i = 0; i < strengths().size(); ++i) {
    const Tally lost_here = lost(setting, i, rule);
    const bool any = lost_here.events > 0, all = lost_here.runs > 0 && lost_here.events == lost_here.runs;
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

Panel limit_panel(const Table& table, const std::string& x_label, const std::string& y_label,
                  std::pair<double, double> grid_position) {
  Panel panel{table.title, x_label, y_label};
  for (const CarrierName& carrier : kCarriers) {
    const std::string column = carrier.column, x = table.columns[0].name;
    panel.curves.push_back(
        {table.name, x, column + "_bound", CurveStyle::dashed, std::string(carrier.label) + ", derived"});
    panel.curves.push_back({table.name, x, column + "_carried", CurveStyle::dots, carrier.label});
  }
  panel.grid_position = grid_position;
  return panel;
}

}  // namespace remote_touch
