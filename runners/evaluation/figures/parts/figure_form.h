// The form in which figures are written: tables by their columns, panels of curves, and claims.
#pragma once

#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/storage/result_file.h"
#include "analysis/trace/interval_estimates.h"
#include "core/points/vector.h"

namespace remote_touch {

struct ColumnName {
  std::string name, units, long_name;
};
// Each row has one number for every column.
using TableRows = std::vector<std::vector<double>>;
void add_rows(Table& table, const std::vector<ColumnName>& columns, const TableRows& rows);
Table table_of(const std::string& name, const std::string& title, const std::vector<ColumnName>& columns,
               const TableRows& rows);

// Columns of numbers. A recipe states a table as Table{name, title, {{column, units, meaning, numbers}, ...}}
// and makes the numbers with these: one for each tick of a trace, run of a list or cell of a sweep.
using Numbers = std::vector<double>;

// Returns value(i) for each i below `count`.
template <class Value>
Numbers each_of(std::size_t count, Value&& value) {
  return values_where(
      count, [](std::size_t) { return true; }, value);
}
// Returns value(element) for each element of a list; `value` may be a member of the element.
template <class List, class Value>
Numbers each(const List& list, Value&& value) {
  return each_of(std::size(list), [&](std::size_t i) { return std::invoke(value, list[i]); });
}
// Returns whole numbers, such as counts, as numbers.
template <class Whole>
Numbers doubles(const std::vector<Whole>& values) {
  return {values.begin(), values.end()};
}
Numbers norms(const std::vector<Vec3>& vectors);
Numbers norms_between(const std::vector<Vec3>& a, const std::vector<Vec3>& b);  // of a - b
Numbers along(int axis, const std::vector<Vec3>& vectors);                      // components: x is 0
Numbers minus(Numbers values, const Numbers& others);                           // pre: as many others
Numbers scaled(double factor, Numbers values);
Numbers magnitudes(Numbers values);
double rms(const Numbers& values);  // NaN without values
// Returns the values whose index qualifies: where(distance, is_pressed) before max_of(), mean() or rms().
template <class Qualifies>
Numbers where(const Numbers& values, Qualifies&& qualifies) {
  return values_where(values.size(), qualifies, [&](std::size_t i) { return values[i]; });
}
// Returns the values of these rows.
Numbers at(const std::vector<std::size_t>& rows, const Numbers& values);
// Returns the number of i below `count` for which holds(i) is true.
template <class Holds>
double count_where(std::size_t count, Holds&& holds) {
  double number = 0;
  for (std::size_t i = 0; i < count; ++i) number += holds(i) ? 1 : 0;
  return number;
}

// Returns these rows of a table, or every step-th row from the first one on.
Table rows_of(Table table, const std::vector<std::size_t>& rows);
Table every(std::size_t step, Table table);

// A column that takes its number in each row from an element of a list.
template <class Element>
struct ColumnOver {
  std::string name, units, long_name;
  std::function<double(const Element&)> value;
};
// Adds the columns to a table with one row for each element.
template <class Element>
void add_columns(Table& table, const std::vector<Element>& elements,
                 const std::vector<ColumnOver<Element>>& columns) {
  for (const ColumnOver<Element>& column : columns) {
    std::vector<double> values;
    for (const Element& element : elements) values.push_back(column.value(element));
    table.add(column.name, column.units, column.long_name, std::move(values));
  }
}
template <class Element>
Table table_over(const std::string& name, const std::string& title, const std::vector<Element>& elements,
                 const std::vector<ColumnOver<Element>>& columns) {
  Table table{name, title};
  add_columns(table, elements, columns);
  return table;
}

template <class Run>
struct Quantity {
  std::string name, unit;
  std::function<double(const Run&)> of;
};
// Returns a table of several runs: a row for each quantity, a column for each run.
template <class Run>
Table quantity_table(const std::string& name, const std::string& title, const std::vector<std::string>& names,
                     const std::vector<Run>& runs, const std::vector<Quantity<Run>>& quantities) {
  std::vector<std::string> rows, units;
  for (const Quantity<Run>& quantity : quantities)
    rows.push_back(quantity.name), units.push_back(quantity.unit);
  Table table{name, title};
  table.columns.push_back({"quantity", "1", "what was measured", rows, 1, {}});
  table.columns.push_back({"unit", "1", "unit of the values in this row", units, 1, {}});
  for (std::size_t r = 0; r < runs.size(); ++r) {
    // The unit changes from row to row.
    add_columns<Quantity<Run>>(table, quantities,
                               {{names.at(r), "1", "value of this run",
                                 [&](const Quantity<Run>& quantity) { return quantity.of(runs[r]); }}});
  }
  return table;
}

// The place of a panel, and the limits of its axes.
struct PanelFrame {
  std::optional<std::pair<double, double>> at = {}, x_range = {}, y_range = {};  // at: row, column
  bool equal_aspect = false;
};
Panel plot(const std::string& title, const std::string& x_label, const std::string& y_label,
           std::vector<Curve> curves, const PanelFrame& frame = {});
// Panels below each other in a column of a figure, each with curves of one table over the same column.
struct PanelColumn {
  // The column y of the table over its column x.
  struct CurveOfY {
    std::string y;
    CurveStyle style = CurveStyle::line;
    std::string label = {};
  };
  Figure& figure;
  std::string table, x, x_label;
  int column = 0;
  std::optional<std::pair<double, double>> x_range = {};
  int row = 0;  // of the next panel

  Panel& add(const std::string& title, const std::string& y_label, const std::vector<CurveOfY>& curves,
             std::optional<std::pair<double, double>> y_range = {});
};
// Places the panels of a figure in rows of so many columns.
void place_in_rows(Figure& figure, std::size_t columns);

// Adds claims to a figure, in the order of the calls. Every text begins with the opening, and every claim
// gets the mark: of_map or set_up, and the source of the figure. paper: the value of the source as text.
class Claims {
 public:
  explicit Claims(Figure& figure, std::string opening = "", bool Claim::*mark = nullptr)
      : figure_(figure), opening_(std::move(opening)), mark_(mark) {}
  void at_most(const std::string& claim, double measured, double limit, const std::string& unit,
               const std::string& paper = "-") const;
  void at_least(const std::string& claim, double measured, double limit, const std::string& unit,
                const std::string& paper = "-") const;
  void between(const std::string& claim, double measured, double low, double high, const std::string& unit,
               const std::string& paper = "-") const;
  void differs(const std::string& claim, double measured, double low, double high, const std::string& unit,
               const std::string& paper = "-") const;

 private:
  void add(Claim claim) const;

  Figure& figure_;
  std::string opening_;
  bool Claim::*mark_;
};

// Returns a claim as the line that commands print, without its end.
std::string line_of(const Claim& claim);
// Leaves a claim about whole maps open, because a share of a coarse map is not that of the whole map.
void leave_open(Claim& claim);
// Returns what the caption of a figure says of maps that were made in part.
std::string coarse_text(std::size_t made_runs, std::size_t runs, int coarse);

// claims.json: the claims of a folder's figures, with their verdicts.

class ClaimsFile {
 public:
  // Keeps the claims of an earlier call in the folder until their figure is made again. order: names of the
  // figures, in the order of the file.
  ClaimsFile(std::filesystem::path file, std::vector<std::string> order);
  ~ClaimsFile();
  ClaimsFile(const ClaimsFile&) = delete;
  ClaimsFile& operator=(const ClaimsFile&) = delete;

  // Replaces a figure's claims and writes the file, so that an interruption keeps what is done.
  void replace(const std::string& figure, std::span<const Claim> claims);

 private:
  std::filesystem::path file_;
  std::vector<std::string> order_;
  std::unique_ptr<std::vector<nlohmann::ordered_json>> claims_;  // a list for each name; last: other figures
};

}  // namespace remote_touch
