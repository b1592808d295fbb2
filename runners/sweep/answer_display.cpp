#include "runners/sweep/sweep_answer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "analysis/report/report.h"
#include "analysis/sweeps/sweep_result.h"
#include "analysis/trace/interval_estimates.h"
#include "core/parameters/parameter.h"

namespace remote_touch {
namespace {

constexpr std::size_t kMaxCurves = 8;

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

// Returns the number of the first axis of numbers that has more than one value.
std::optional<std::size_t> axis_of_numbers(const AnswerTable& answer) {
  for (std::size_t axis = 0; axis < answer.axes; ++axis)
    if (const auto* values = numbers_in(answer.table.columns[axis]);
        values && std::set<double>(values->begin(), values->end()).size() > 1)
      return axis;
  return {};
}

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

struct AnswerCurve {
  std::string label;
  std::vector<double> values;  // of the other axes; a name by its number
  std::vector<std::size_t> rows;
};

double number_in(const Column& column, std::size_t row) {
  if (const auto* numbers = numbers_in(column)) return (*numbers)[row];
  return std::get<std::vector<std::int32_t>>(column.values)[row];
}

// Returns the text for some axes of a row: "method = old, r c = 5 mm"; `except` is left out.
std::string row_label(const AnswerTable& answer, std::size_t row, std::optional<std::size_t> except) {
  std::string label;
  for (std::size_t axis = 0; axis < answer.axes; ++axis) {
    const Column& column = answer.table.columns[axis];
    if (axis == except) continue;
    label += (label.empty() ? "" : ", ") + in_words(column.name) + " = " +
             with_unit(axis_text(column, row), column.value_names.empty() ? column.units : "1");
  }
  return label;
}

// Returns the rows of each combination of the axes other than x, in the order of the table; none if there are
// too many.
std::vector<AnswerCurve> curves_of(const AnswerTable& answer, std::size_t x) {
  std::vector<AnswerCurve> curves;
  for (std::size_t row = 0; row < answer.value().length(); ++row) {
    std::vector<double> others;
    for (std::size_t axis = 0; axis < answer.axes; ++axis)
      if (axis != x) others.push_back(number_in(answer.table.columns[axis], row));
    auto curve = std::find_if(curves.begin(), curves.end(),
                              [&](const AnswerCurve& each) { return each.values == others; });
    if (curve == curves.end()) curve = curves.insert(curve, {row_label(answer, row, x), others, {}});
    curve->rows.push_back(row);
    if (curves.size() > kMaxCurves) return {};
  }
  return curves;
}

// Returns the rows with x, value and interval as a table with increasing x.
Table table_of_curve(const AnswerTable& answer, const Column& x, std::vector<std::size_t> rows,
                     const std::string& name, const std::string& label) {
  const std::vector<double>& place = *numbers_in(x);
  std::sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) { return place[a] < place[b]; });
  Table table{name, label.empty() ? answer.table.title : label, {axis_at(x, rows)}};
  for (const Column* column : {&answer.value(), &answer.low(), &answer.high()})
    table.columns.push_back(axis_at(*column, rows));
  return table;
}

std::vector<std::size_t> with_value(const AnswerTable& answer, const std::vector<std::size_t>& rows) {
  std::vector<std::size_t> some;
  for (const std::size_t row : rows)
    if (std::isfinite((*numbers_in(answer.value()))[row])) some.push_back(row);
  return some;
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
  const std::optional<std::size_t> x = axis_of_numbers(answer);
  if (!x) return;
  const Column& axis = table.columns[*x];
  Panel panel{in_words(table.title), in_words(axis.name), in_words(table.title)};
  for (const AnswerCurve& curve : curves_of(answer, *x)) {
    const std::vector<std::size_t> rows = with_value(answer, curve.rows);
    if (rows.empty()) continue;
    const std::string name = table.name + "_" + std::to_string(panel.curves.size() / 2 + 1);
    const bool is_line = rows.size() > 1;
    add_curves(figure, panel, table_of_curve(answer, axis, rows, name, curve.label),
               is_line ? CurveStyle::band : CurveStyle::intervals,
               is_line ? CurveStyle::line : CurveStyle::dots, curve.label);
  }
  if (!panel.curves.empty()) figure.panels.push_back(panel);
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

}  // namespace

void add_answer_limits(Figure& figure, const Table& of_answer, std::size_t axes, const Column& along) {
  const Table table = of_answer;  // it may be one of the figure, whose list grows
  const AnswerTable answer{table, axes};
  const std::optional<std::size_t> axis = axis_of_numbers(answer);
  Column x;
  std::string x_label;
  std::vector<AnswerCurve> curves;
  if (axis) {
    x = table.columns[*axis], x_label = in_words(x.name), curves = curves_of(answer, *axis);
  } else if (answer.value().length() <= kMaxCurves) {
    std::vector<double> places;
    curves.emplace_back();
    for (std::size_t row = 0; row < answer.value().length(); ++row) {
      places.push_back(static_cast<double>(row + 1)), curves.front().rows.push_back(row);
      const std::string label = row_label(answer, row, std::nullopt);
      if (!label.empty()) x_label += (row > 0 ? "; " : "row ") + std::to_string(row + 1) + ": " + label;
    }
    x = {"row", "1", "number of the row", places};
  }
  Panel panel{in_words(table.title), x_label, in_words(along.name)};
  int number = 0;
  for (const AnswerCurve& curve : curves) {
    const std::string name = table.name + "_" + std::to_string(++number);
    const auto known = with_value(answer, curve.rows);
    if (!known.empty())
      add_curves(figure, panel, table_of_curve(answer, x, known, name, curve.label), CurveStyle::intervals,
                 known.size() > 1 && axis ? CurveStyle::line : CurveStyle::dots, curve.label);
    for (const End& end : kEnds) {
      const auto rows = rows_at(table, curve.rows, end);
      if (rows.empty()) continue;
      const std::string label = (curve.label.empty() ? "" : curve.label + ": ") + end.place;
      Table marks = table_of_curve(answer, x, rows, name + end.table, label);
      put_at_end(marks, along, end);
      add_curves(figure, panel, std::move(marks), CurveStyle::intervals, CurveStyle::dots, label);
    }
  }
  if (!panel.curves.empty()) figure.panels.push_back(panel);
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
