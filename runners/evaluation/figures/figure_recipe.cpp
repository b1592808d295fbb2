#include "runners/evaluation/figures/figure_recipe.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "analysis/storage/atomic_file.h"
#include "analysis/trace/measures.h"
#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "runners/sweep/sweep_run.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {

Trace FigureContext::run(const Experiment& experiment) {
  uses(experiment);
  return simulated(experiment);
}

std::vector<Trace> FigureContext::run(const std::vector<Experiment>& experiments) {
  for (const Experiment& experiment : experiments) uses(experiment);
  return collect(experiments.size(), [&](std::size_t i) { return simulated(experiments[i]); });
}

std::string FigureContext::configurations() const {
  return "[" + joined(configurations_, ", ") + "]";
}

Trace FigureContext::simulated(const Experiment& experiment) {
  SimulationOptions options;
  options.kernels = &kernels_;
  options.stop = stop_;
  RunReport report;
  options.report = &report;
  Trace trace = simulate(experiment, options);
  notes_.add(report.notes);
  return trace;
}

Sweep FigureContext::map(const std::string& name, const std::vector<std::string>& overrides) {
  const Sweep whole = Sweep::load(name, overrides);
  Sweep made = coarse_ > 1 ? whole.thinned(coarse_) : whole;
  runs_of_maps_ += whole.plan().run_count(), made_runs_of_maps_ += made.plan().run_count();
  return made;
}

SweepResult FigureContext::sweep(const Sweep& sweep) {
  SweepResult result = run_sweep(sweep, {&kernels_, stop_, {}, runs_});
  note(sweep.to_json());
  inputs_.add(sweep.inputs());
  const auto failed = result.runs_in(RunState::failed);
  if (!failed.empty()) throw InputError(sweep.title(), "a run failed: " + result.error[failed.front()]);
  notes_.add(result);
  return result;
}

std::vector<NamedRun> named_runs(FigureContext& context, const std::vector<NamedExperiment>& experiments) {
  std::vector<Experiment> loaded = list_of(experiments, [](const NamedExperiment& one) {
    return Experiment::load(one.experiment, one.overrides);
  });
  std::vector<Trace> traces = context.run(loaded);
  std::vector<NamedRun> runs;
  for (std::size_t i = 0; i < loaded.size(); ++i)
    runs.push_back({experiments[i].name, experiments[i].label, std::move(loaded[i]), std::move(traces[i])});
  return runs;
}

std::vector<double> measured(const SweepResult& sweep, const std::string& measure,
                             const std::vector<std::optional<std::size_t>>& places) {
  return where(sweep.measure(measure), [&](std::size_t run) {
    const std::vector<std::size_t> at = sweep.axis_indices(sweep.cell_of(run));
    bool has_places = true;
    for (std::size_t axis = 0; axis < places.size(); ++axis)
      has_places = has_places && (!places[axis] || *places[axis] == at[axis]);
    return has_places;
  });
}

namespace {

// Returns the radius at each frame's time of capture, one value for each tick, as the rules compute it.
std::vector<double> radii(const Experiment& experiment, const Trace& trace, const Scenario& scenario) {
  const FixtureAssignment fixtures = experiment.build_fixtures();
  std::vector<double> radius_m;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    if (i > 0 && !trace.frame_update(i)) {
      radius_m.push_back(radius_m.back());
      continue;
    }
    PointCloud point;
    point.append(Vec3::Zero());
    fixtures.assign(point, scenario.captured_s(trace.frame_index[i]));
    radius_m.push_back(point.fixture_radius_m.front());
  }
  return radius_m;
}

}  // namespace

std::vector<FixtureRun> run_fixtures(FigureContext& context, const std::vector<Experiment>& experiments) {
  std::vector<Trace> traces = context.run(experiments);
  std::vector<FixtureRun> runs;
  for (std::size_t r = 0; r < experiments.size(); ++r) {
    auto scenario = experiments[r].build_scenario(kernels_for(Isa::x86_64));
    std::vector<double> radius_m = radii(experiments[r], traces[r], *scenario);
    runs.push_back({std::move(traces[r]), std::move(scenario), std::move(radius_m)});
  }
  return runs;
}

double most(const std::vector<std::int32_t>& counts) {
  return max_of(doubles(counts));
}

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

Table table_of(const std::string& name, const std::string& title, const std::vector<ColumnName>& columns,
               const TableRows& rows) {
  Table table{name, title};
  for (std::size_t c = 0; c < columns.size(); ++c)
    table.add(columns[c].name, columns[c].units, columns[c].long_name,
              each(rows, [&](const std::vector<double>& row) { return row.at(c); }));
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

void claim_finite(const Claims& claims, const Trace& trace, const std::string& paper) {
  claims.at_most("all numbers are finite: fraction of ticks with one that is not", non_finite_fraction(trace),
                 0, "fraction", paper);
}

void add_side_claim(Figure& figure, const std::string& where, const Trace& trace) {
  Claims(figure, where)
      .at_most("the proxy is never on the wrong side of the surface: fraction of ticks in which it is",
               wrong_side_fraction(trace), 0, "fraction", "none");
}

void add_sound_claims(Figure& figure, const std::string& where, const Trace& trace) {
  const Claims claims(figure, where);
  claim_finite(claims, trace, "none");
  claims.at_most("the HIP is never held back without force: fraction of ticks in which it is",
                 no_force_fraction(trace, kContactRadius_m), 0, "fraction", "none");
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
