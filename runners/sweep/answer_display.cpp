#include "runners/sweep/sweep_answer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "analysis/report/report.h"
#include "analysis/sweeps/sweep_result.h"
#include "analysis/trace/interval_estimates.h"
#include "core/parameters/parameter.h"

namespace remote_touch {
namespace {

constexpr std::size_t kMaxCurves = 8, kMaxPanels = 6;

const std::vector<double>* numbers_in(const Column& column) {
  return std::get_if<std::vector<double>>(&column.values);
}

// A table of an answer, with its axes.
struct AnswerTable {
  const Table& table;
  std::size_t axes;

  const Column& value() const { return table.columns[axes]; }
  const Column& low() const { return table.columns[axes + 1]; }
  const Column& high() const { return table.columns[axes + 2]; }
};

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit == "1" ? text : text + " " + unit;
}

// Returns a text for a picture: in names such as acceleration_m_per_s2 and popped_through the unit is left
// out and the underscores are blanks. Symbols such as r_c stay.
std::string in_words(const std::string& text) {
  constexpr std::size_t kLongestSymbol = 3;
  std::string result, word;
  const auto add_word = [&] {
    if (word.size() > kLongestSymbol && word.find('_') != std::string::npos) {
      if (const Unit* unit = unit_of(word)) word.resize(word.size() - std::string(unit->ending).size());
      std::replace(word.begin(), word.end(), '_', ' ');
    }
    result += word;
    word.clear();
  };
  for (const char c : text) {
    if (c == ' ') add_word(), result += c;
    if (c != ' ') word += c;
  }
  add_word();
  return result;
}

using Axes = std::vector<std::size_t>;

// The rows in which some axes have the same values.
struct RowGroup {
  std::string label;  // "method = old, r c = 5 mm"
  std::vector<std::size_t> rows;
};

double number_in(const Column& column, std::size_t row) {
  if (const auto* numbers = numbers_in(column)) return (*numbers)[row];
  return std::get<std::vector<std::int32_t>>(column.values)[row];
}

std::string row_label(const AnswerTable& answer, std::size_t row, const Axes& axes) {
  std::string label;
  for (const std::size_t axis : axes) {
    const Column& column = answer.table.columns[axis];
    label += (label.empty() ? "" : ", ") + in_words(column.name) + " = " +
             with_unit(axis_text(column, row), column.value_names.empty() ? column.units : "1");
  }
  return label;
}

// Returns the groups of some rows by these axes, in the order of the table.
std::vector<RowGroup> grouped(const AnswerTable& answer, const std::vector<std::size_t>& rows,
                              const Axes& axes) {
  std::vector<RowGroup> groups;
  std::map<std::vector<double>, std::size_t> numbers;  // of the groups, by the values of the axes
  for (const std::size_t row : rows) {
    std::vector<double> values;
    for (const std::size_t axis : axes) values.push_back(number_in(answer.table.columns[axis], row));
    const auto [group, is_new] = numbers.emplace(values, groups.size());
    if (is_new) groups.push_back({row_label(answer, row, axes), {}});
    groups[group->second].rows.push_back(row);
  }
  return groups;
}

std::vector<std::size_t> all_rows(const AnswerTable& answer) {
  std::vector<std::size_t> rows(answer.value().length());
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

std::vector<std::size_t> with_value(const AnswerTable& answer, std::vector<std::size_t> rows) {
  std::erase_if(rows, [&](std::size_t row) { return !std::isfinite((*numbers_in(answer.value()))[row]); });
  return rows;
}

// Returns how many values an axis has.
std::size_t count_along(const AnswerTable& answer, std::size_t axis) {
  std::set<double> values;
  for (std::size_t row = 0; row < answer.value().length(); ++row)
    values.insert(number_in(answer.table.columns[axis], row));
  return values.size();
}

Axes without(Axes axes, std::size_t axis) {
  std::erase(axes, axis);
  return axes;
}

// How a table is drawn: over x, with a panel for each value of an axis or one for all, and with a curve for
// each combination of the other axes.
struct Plan {
  std::size_t x = 0;
  Axes panels, curves;
};

// Returns the plan with the first axis of numbers, else of names, as x. If that has too many curves, the
// longest such axis is x; if there are still too many, the shortest axis that helps has a panel for each
// value. Empty if no axis has two values.
std::optional<Plan> plan_of(const AnswerTable& answer) {
  Axes axes, numbers, names;
  std::vector<std::size_t> count;
  for (std::size_t axis = 0; axis < answer.axes; ++axis) {
    axes.push_back(axis), count.push_back(count_along(answer, axis));
    if (count[axis] > 1) (numbers_in(answer.table.columns[axis]) ? numbers : names).push_back(axis);
  }
  const Axes& across = numbers.empty() ? names : numbers;
  if (across.empty()) return {};
  const auto combinations = [&](const Axes& some) {
    std::size_t product = 1;
    for (const std::size_t axis : some) product *= count[axis];
    return product;
  };
  const auto is_shorter = [&](std::size_t a, std::size_t b) { return count[a] < count[b]; };
  const std::size_t longest = *std::max_element(across.begin(), across.end(), is_shorter);
  for (const std::size_t x : {across.front(), longest})
    if (combinations(without(axes, x)) <= kMaxCurves) return Plan{x, {}, without(axes, x)};
  const Axes others = without(axes, longest);
  Axes shortest_first = others;
  std::stable_sort(shortest_first.begin(), shortest_first.end(), is_shorter);
  for (const std::size_t axis : shortest_first)
    if (count[axis] > 1 && count[axis] <= kMaxPanels && combinations(without(others, axis)) <= kMaxCurves)
      return Plan{longest, {axis}, without(others, axis)};
  return Plan{longest, {}, others};
}

Panel panel_of(const AnswerTable& answer, const RowGroup& part, const std::string& x_label,
               const std::string& y_label) {
  const std::string title = in_words(answer.table.title);
  return {part.label.empty() ? title : title + ": " + part.label, x_label, y_label};
}

// Leaves out what is too much for a panel, and says so in its title and in the caption.
void keep_first(std::vector<RowGroup>& curves, Panel& panel, Figure& figure, const std::string& table) {
  if (curves.size() <= kMaxCurves) return;
  const std::string shown =
      "the first " + std::to_string(kMaxCurves) + " of " + std::to_string(curves.size()) + " curves";
  panel.title += ", " + shown;
  figure.caption += "The panel of " + table + " has " + shown + "; the table has all. ";
  curves.resize(kMaxCurves);
}

// Returns the rows with x, value and interval as a table with increasing x.
Table table_of_curve(const AnswerTable& answer, const Column& x, std::vector<std::size_t> rows,
                     const std::string& name, const std::string& label) {
  std::sort(rows.begin(), rows.end(),
            [&](std::size_t a, std::size_t b) { return number_in(x, a) < number_in(x, b); });
  Table table{name, label.empty() ? answer.table.title : label, {axis_at(x, rows)}};
  for (const Column* column : {&answer.value(), &answer.low(), &answer.high()})
    table.columns.push_back(axis_at(*column, rows));
  return table;
}

// Adds a table and two curves: the intervals or the band, and the values.
void add_curves(Figure& figure, Panel& panel, Table table, CurveStyle interval, CurveStyle value,
                const std::string& label) {
  Curve ends{table.name, table.columns[0].name, table.columns[2].name, interval};
  ends.z = table.columns[3].name;
  panel.curves.push_back(ends);
  panel.curves.push_back({table.name, table.columns[0].name, table.columns[1].name, value, label});
  figure.tables.push_back(std::move(table));
}

}  // namespace

bool is_of_curve(const Figure& figure, const Table& table) {
  for (const Panel& panel : figure.panels)
    for (const Curve& curve : panel.curves)
      if (curve.table == table.name) return true;
  return false;
}

std::string axis_text(const Column& axis, std::size_t row) {
  if (const auto* numbers = numbers_in(axis)) {
    return formatted("%.10g", (*numbers)[row]);
  }
  const std::int32_t number = std::get<std::vector<std::int32_t>>(axis.values)[row];
  return axis.value_names.empty() ? std::to_string(number)
                                  : axis.value_names[static_cast<std::size_t>(number)];
}

void add_answer_panel(Figure& figure, const Table& of_answer, std::size_t axes) {
  const Table table = of_answer;  // it may be one of the figure, whose list grows
  const AnswerTable answer{table, axes};
  const std::optional<Plan> plan = plan_of(answer);
  if (!plan) return;
  const Column& x = table.columns[plan->x];
  int number = 0;
  for (const RowGroup& part : grouped(answer, with_value(answer, all_rows(answer)), plan->panels)) {
    Panel panel = panel_of(answer, part, in_words(x.name), in_words(table.title));
    std::vector<RowGroup> curves = grouped(answer, part.rows, plan->curves);
    keep_first(curves, panel, figure, table.name);
    for (const RowGroup& curve : curves) {
      const std::string name = table.name + "_" + std::to_string(++number);
      const bool is_line = curve.rows.size() > 1 && numbers_in(x);
      add_curves(figure, panel, table_of_curve(answer, x, curve.rows, name, curve.label),
                 is_line ? CurveStyle::band : CurveStyle::intervals,
                 is_line ? CurveStyle::line : CurveStyle::dots, curve.label);
    }
    figure.panels.push_back(panel);
  }
}

namespace {

// A place of a limit that is not inside, and the end of the axis at which it has a mark. An event in all or
// in none of the runs says on which side its limit is only if the direction is known.
struct End {
  const char *place, *table;
  bool is_last = false, is_beyond = true;
};
constexpr End kEnds[] = {
    {"below the first value", "_below"},           {"above the last value", "_above", true},
    {"below the values with runs", "_below_runs"}, {"above the values with runs", "_above_runs", true},
    {"all of the runs", "_all", false, false},     {"none of the runs", "_none", true, false}};

std::vector<std::size_t> rows_at(const Table& table, const std::vector<std::size_t>& rows, const End& end) {
  const Column& place = table.columns.back();
  const auto& numbers = std::get<std::vector<std::int32_t>>(place.values);
  std::vector<std::size_t> some;
  for (const std::size_t row : rows)
    if (place.value_names[static_cast<std::size_t>(numbers[row])] == end.place) some.push_back(row);
  return some;
}

// Puts limits that are not known at the end of the axis; their intervals are open beyond it.
void put_at_end(Table& table, const Column& along, const End& end) {
  const std::vector<double>& x = *numbers_in(along);
  const double at = end.is_last ? max_of(x) : min_of(x), infinity = std::numeric_limits<double>::infinity();
  auto &values = std::get<std::vector<double>>(table.columns[1].values),
       &inner = std::get<std::vector<double>>(table.columns[end.is_last ? 2 : 3].values),
       &outer = std::get<std::vector<double>>(table.columns[end.is_last ? 3 : 2].values);
  for (std::size_t row = 0; row < values.size(); ++row) {
    values[row] = at;
    if (!end.is_beyond) continue;
    outer[row] = end.is_last ? infinity : -infinity;
    if (std::isnan(inner[row])) inner[row] = at;
  }
}

// Adds the limits of a curve, and marks for those that are not inside.
void add_limits_of(Figure& figure, Panel& panel, const AnswerTable& answer, const RowGroup& curve,
                   const Column& x, const Column& along, const std::string& name) {
  const std::vector<std::size_t> known = with_value(answer, curve.rows);
  if (!known.empty())
    add_curves(figure, panel, table_of_curve(answer, x, known, name, curve.label), CurveStyle::intervals,
               known.size() > 1 && numbers_in(x) ? CurveStyle::line : CurveStyle::dots, curve.label);
  for (const End& end : kEnds) {
    const std::vector<std::size_t> rows = rows_at(answer.table, curve.rows, end);
    if (rows.empty()) continue;
    const std::string label = (curve.label.empty() ? "" : curve.label + ": ") + end.place;
    Table marks = table_of_curve(answer, x, rows, name + end.table, label);
    put_at_end(marks, along, end);
    add_curves(figure, panel, std::move(marks), CurveStyle::intervals, CurveStyle::dots, label);
  }
}

}  // namespace

void add_answer_limits(Figure& figure, const Table& of_answer, std::size_t axes, const Column& along) {
  const Table table = of_answer;  // it may be one of the figure, whose list grows
  const AnswerTable answer{table, axes};
  const std::optional<Plan> plan = plan_of(answer);
  // No axis has two values: a single limit.
  const Column x =
      plan ? table.columns[plan->x]
           : Column{"row", "1", "number of the row", std::vector<double>(answer.value().length(), 1)};
  int number = 0;
  for (const RowGroup& part : grouped(answer, all_rows(answer), plan ? plan->panels : Axes{})) {
    Panel panel = panel_of(answer, part, plan ? in_words(x.name) : "", in_words(along.name));
    std::vector<RowGroup> curves = grouped(answer, part.rows, plan ? plan->curves : Axes{});
    keep_first(curves, panel, figure, table.name);
    for (const RowGroup& curve : curves)
      add_limits_of(figure, panel, answer, curve, x, along, table.name + "_" + std::to_string(++number));
    if (!panel.curves.empty()) figure.panels.push_back(panel);
  }
}

namespace {

constexpr std::size_t kMostRows = 60;

// True for the columns before the answer itself: the axes, whose values must not look alike.
bool is_axis(const Table& table, const Column& column) {
  const auto named = [&](const char* name) {
    return std::find_if(table.columns.begin(), table.columns.end(),
                        [&](const Column& each) { return each.name == name; });
  };
  const auto renamed = named("value_of_answer");  // an axis is called "value"
  return &column < &*(renamed == table.columns.end() ? named("value") : renamed);
}

void add_cell(ReportRow& shown, const Table& table, const Column& column, std::size_t row) {
  const std::string heading = column.name + "\n" + (column.units == "1" ? "" : column.units);
  const auto* const numbers = numbers_in(column);
  if (const auto* const words = std::get_if<std::vector<std::string>>(&column.values))
    shown.show(heading, (*words)[row].empty() ? "-" : (*words)[row]);
  else if (!numbers || is_axis(table, column))
    shown.show(heading, axis_text(column, row),
               column.value_names.empty() ? ReportValue(number_in(column, row)) : ReportValue());
  else
    shown.show(heading, std::isnan((*numbers)[row]) ? "-" : formatted("%.5g", (*numbers)[row]),
               (*numbers)[row]);
}

void add_table(const Table& table, Report& report) {
  const std::size_t all = table.columns.front().length(), rows = std::min(all, kMostRows);
  ReportTable shown;
  shown.rows.resize(rows);
  for (std::size_t row = 0; row < rows; ++row)
    for (const Column& column : table.columns) add_cell(shown.rows[row], table, column, row);
  report.line(table.title);
  report.add(shown);
  if (all > rows) report.line("  and " + std::to_string(all - rows) + " more rows: -o FILE.csv writes all");
}

}  // namespace

std::string answer_text(const Figure& answer, std::size_t done, std::size_t asked) {
  Report report;
  if (!answer.caption.empty()) report.line(answer.caption);
  for (const Table& table : answer.tables)
    if (!is_of_curve(answer, table)) add_table(table, report);
  if (done < asked)
    report.line("  note: " + std::to_string(asked - done) + " of " + std::to_string(asked) +
                " runs are not finished and are left out");
  return report.text();
}

}  // namespace remote_touch
