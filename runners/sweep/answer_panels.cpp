#include "runners/sweep/answer_panels.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <set>

#include "analysis/sweeps/cell_groups.h"
#include "core/parameters/unit.h"

namespace remote_touch {

namespace {

constexpr std::size_t kMaxCurves = 8;

const std::vector<double>* numbers_in(const Column& column) {
  return std::get_if<std::vector<double>>(&column.values);
}

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

// Returns the rows of each combination of the other axes, in the order of the table.
std::vector<AnswerCurve> curves_of(const AnswerTable& answer, std::size_t x) {
  const std::vector<double>& value = numbers(answer.table, answer.value);
  std::vector<AnswerCurve> curves;
  for (std::size_t row = 0; row < value.size(); ++row) {
    std::string label;
    std::vector<double> others;
    for (std::size_t axis = 0; axis < answer.axes; ++axis) {
      const Column& column = answer.table.columns[axis];
      if (axis == x) continue;
      others.push_back(number_in(column, row));
      label += (label.empty() ? "" : ", ") + in_words(column.name) + " = " +
               with_unit(axis_text(column, row), column.value_names.empty() ? column.units : "1");
    }
    auto curve = std::find_if(curves.begin(), curves.end(),
                              [&](const AnswerCurve& each) { return each.values == others; });
    if (curve == curves.end()) curve = curves.insert(curve, {label, others, {}});
    if (std::isfinite(value[row])) curve->rows.push_back(row);
    if (curves.size() > kMaxCurves) return {};
  }
  return curves;
}

// Returns the rows as a table with increasing x.
Table table_of_curve(const AnswerTable& answer, std::size_t x, std::vector<std::size_t> rows,
                     const std::string& name, const std::string& label) {
  const std::vector<double>& place = *numbers_in(answer.table.columns[x]);
  std::sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) { return place[a] < place[b]; });
  Table table{name, label.empty() ? answer.table.title : label};
  for (const Column& column : answer.table.columns)
    if (&column == &answer.table.columns[x] || column.name == answer.value || column.name == answer.low ||
        column.name == answer.high)
      table.columns.push_back(axis_at(column, rows));
  return table;
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
    char text[32];
    std::snprintf(text, sizeof text, "%.10g", (*numbers)[row]);
    return text;
  }
  const std::int32_t number = std::get<std::vector<std::int32_t>>(axis.values)[row];
  return axis.value_names.empty() ? std::to_string(number)
                                  : axis.value_names[static_cast<std::size_t>(number)];
}

void add_answer_panel(Figure& figure, const AnswerTable& answer) {
  const std::optional<std::size_t> x = axis_of_numbers(answer);
  if (!x) return;
  const Column& axis = answer.table.columns[*x];
  Panel panel{in_words(answer.table.title), in_words(axis.name), answer.value};
  for (const AnswerCurve& curve : curves_of(answer, *x)) {
    if (curve.rows.size() < 2) continue;
    const std::string name = answer.table.name + "_" + std::to_string(panel.curves.size() / 2 + 1);
    figure.tables.push_back(table_of_curve(answer, *x, curve.rows, name, curve.label));
    Curve band{name, axis.name, answer.low, CurveStyle::band};
    band.z = answer.high;
    panel.curves.push_back(band);
    panel.curves.push_back({name, axis.name, answer.value, CurveStyle::line, curve.label});
  }
  if (!panel.curves.empty()) figure.panels.push_back(panel);
}

}  // namespace remote_touch
