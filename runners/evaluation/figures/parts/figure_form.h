// The form in which figures are written: tables by their columns, panels of curves, and claims.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/storage/result_file.h"

namespace remote_touch {

struct ColumnName {
  std::string name, units, long_name;
};
// Each row has one number for every column.
using TableRows = std::vector<std::vector<double>>;
void add_rows(Table& table, const std::vector<ColumnName>& columns, const TableRows& rows);
Table table_of(const std::string& name, const std::string& title, const std::vector<ColumnName>& columns,
               const TableRows& rows);

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
