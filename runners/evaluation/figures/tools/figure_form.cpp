#include "runners/evaluation/figures/tools/figure_form.h"

namespace remote_touch {

void add_rows(Table& table, const std::vector<ColumnName>& columns, const TableRows& rows) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::vector<double> values;
    for (const std::vector<double>& row : rows) values.push_back(row.at(c));
    table.add(columns[c].name, columns[c].units, columns[c].long_name, std::move(values));
  }
}

Table table_of(const std::string& name, const std::string& title, const std::vector<ColumnName>& columns,
               const TableRows& rows) {
  Table table{name, title};
  add_rows(table, columns, rows);
  return table;
}

Panel plot(const std::string& title, const std::string& x_label, const std::string& y_label,
           std::vector<Curve> curves, const PanelFrame& frame) {
  return {title,         x_label,       y_label, frame.equal_aspect, std::move(curves),
          frame.x_range, frame.y_range, frame.at};
}

void place_in_rows(Figure& figure, std::size_t columns) {
  for (std::size_t i = 0; i < figure.panels.size(); ++i)
    figure.panels[i].grid_position = {i / columns, i % columns};
}

void Claims::add(Claim claim) const {
  if (mark_) claim.*mark_ = true;
  claim.source = figure_.source;
  figure_.claims.push_back(std::move(claim));
}

void Claims::at_most(const std::string& claim, double measured, double limit, const std::string& unit,
                     const std::string& paper) const {
  add(claim_at_most(figure_.name, opening_ + claim, paper, measured, limit, unit));
}

void Claims::at_least(const std::string& claim, double measured, double limit, const std::string& unit,
                      const std::string& paper) const {
  add(claim_at_least(figure_.name, opening_ + claim, paper, measured, limit, unit));
}

void Claims::between(const std::string& claim, double measured, double low, double high,
                     const std::string& unit, const std::string& paper) const {
  add(claim_between(figure_.name, opening_ + claim, paper, measured, low, high, unit));
}

void Claims::differs(const std::string& claim, double measured, double low, double high,
                     const std::string& unit, const std::string& paper) const {
  add(claim_differs(figure_.name, opening_ + claim, paper, measured, low, high, unit));
}

}  // namespace remote_touch
