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

}  // namespace remote_touch
