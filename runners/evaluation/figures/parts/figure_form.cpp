#include "runners/evaluation/figures/parts/figure_form.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/storage/atomic_file.h"
#include "core/parameters/parameter.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {

Numbers norms(const std::vector<Vec3>& vectors) {
  return each(vectors, [](const Vec3& v) { return v.norm(); });
}

Numbers norms_between(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return each_of(a.size(), [&](std::size_t i) { return (a[i] - b[i]).norm(); });
}

Numbers along(int axis, const std::vector<Vec3>& vectors) {
  return each(vectors, [&](const Vec3& v) { return v[axis]; });
}

Numbers minus(Numbers values, const Numbers& others) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] -= others.at(i);
  return values;
}

Numbers scaled(double factor, Numbers values) {
  for (double& value : values) value *= factor;
  return values;
}

Numbers magnitudes(Numbers values) {
  for (double& value : values) value = std::abs(value);
  return values;
}

double rms(const Numbers& values) {
  return std::sqrt(mean(each(values, [](double value) { return value * value; })));
}

Numbers at(const std::vector<std::size_t>& rows, const Numbers& values) {
  return each(rows, [&](std::size_t row) { return values.at(row); });
}

Table rows_of(Table table, const std::vector<std::size_t>& rows) {
  for (Column& column : table.columns)
    std::visit(
        [&](auto& values) {
          auto whole = std::move(values);
          values.clear();
          for (const std::size_t row : rows) values.push_back(whole.at(row));
        },
        column.values);
  return table;
}

Table every(std::size_t step, Table table) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < table.columns.at(0).length(); row += step) rows.push_back(row);
  return rows_of(std::move(table), rows);
}

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

Panel& PanelColumn::add(const std::string& title, const std::string& y_label,
                        const std::vector<CurveOfY>& curves,
                        std::optional<std::pair<double, double>> y_range) {
  Panel panel = plot(title, x_label, y_label, {}, {{{row++, column}}, x_range, y_range});
  for (const CurveOfY& curve : curves) panel.curves.push_back({table, x, curve.y, curve.style, curve.label});
  return figure.panels.emplace_back(std::move(panel));
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

std::string line_of(const Claim& claim) {
  const std::string verdict = claim.verdict == Verdict::fail ? "FAIL" : verdict_name(claim.verdict);
  const std::string paper = claim.verdict == Verdict::differs ? ", " + claim.source + ": " + claim.paper : "";
  const std::string measured = formatted("%.6g", claim.measured);
  return "  " + verdict + std::string(verdict.size() < 7 ? 7 - verdict.size() : 0, ' ') + " " +
         (claim.set_up ? "set-up: " : "") + claim.claim + ": " + measured + " " + claim.unit + " (" +
         claim.criterion + paper + ")";
}

void leave_open(Claim& claim) {
  claim.verdict = Verdict::open;
  claim.criterion += ", not judged on a coarse map";
}

std::string coarse_text(std::size_t made_runs, std::size_t runs, int coarse) {
  return " Made from " + std::to_string(made_runs) + " of the " + std::to_string(runs) +
         " runs of its maps: one in " + std::to_string(coarse) +
         " values of each axis. Claims about a whole map stay open.";
}

namespace {

Json claim_json(const Claim& claim) {
  const Json none;
  return {{"figure", claim.figure},
          {"claim", claim.claim},
          {"paper", claim.paper},
          {"source", claim.source},
          {"measured", std::isfinite(claim.measured) ? Json(claim.measured) : none},
          {"criterion", claim.criterion},
          {"unit", claim.unit},
          {"verdict", verdict_name(claim.verdict)},
          {"set_up", claim.set_up}};
}

}  // namespace

ClaimsFile::ClaimsFile(std::filesystem::path file, std::vector<std::string> order)
    : file_(std::move(file)),
      order_(std::move(order)),
      claims_(std::make_unique<std::vector<Json>>(order_.size() + 1, Json::array())) {
  require_writable(file_);                   // checked first, because reading a pipe would wait for a writer
  const Json earlier = json_in_file(file_);  // if absent or damaged, there is nothing to keep
  if (!earlier.is_array()) return;
  for (const auto& claim : earlier) {
    const auto name = claim.is_object() ? claim.find("figure") : claim.end();
    if (name == claim.end() || !name->is_string()) continue;
    const auto place = std::find(order_.begin(), order_.end(), name->get<std::string>());
    (*claims_)[static_cast<std::size_t>(place - order_.begin())].push_back(claim);
  }
}

ClaimsFile::~ClaimsFile() = default;

void ClaimsFile::replace(const std::string& figure, std::span<const Claim> claims) {
  const auto place = std::find(order_.begin(), order_.end(), figure);
  Json& own = (*claims_)[static_cast<std::size_t>(place - order_.begin())];
  own = Json::array();
  for (const Claim& claim : claims) own.push_back(claim_json(claim));
  Json all = Json::array();
  for (const Json& of_figure : *claims_) all.insert(all.end(), of_figure.begin(), of_figure.end());
  const std::string text = all.dump(2) + "\n";
  write_file_atomically(file_, text.data(), text.size());
}

}  // namespace remote_touch
