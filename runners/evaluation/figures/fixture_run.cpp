#include "runners/evaluation/figures/fixture_run.h"

#include <utility>

#include "analysis/measures/measures.h"
#include "core/kernels/isa.h"

namespace remote_touch {

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

std::vector<FixtureRun> run_fixtures(const FigureContext& context,
                                     const std::vector<Experiment>& experiments) {
  std::vector<Trace> traces = context.run(experiments);
  std::vector<FixtureRun> runs;
  for (std::size_t r = 0; r < experiments.size(); ++r) {
    auto scenario = experiments[r].build_scenario(kernels_for(Isa::x86_64));
    std::vector<double> radius_m = radii(experiments[r], traces[r], *scenario);
    runs.push_back({std::move(traces[r]), std::move(scenario), std::move(radius_m)});
  }
  return runs;
}

namespace {

void claim_none(Figure& figure, const std::string& what, double fraction) {
  figure.claims.push_back(claim_at_most(figure.name, what, "none", fraction, 0, "fraction"));
}

}  // namespace

void add_side_claim(Figure& figure, const std::string& where, const FixtureRun& run) {
  claim_none(figure, where + ": ticks with the proxy on the wrong side of the surface",
             wrong_side_fraction(run.trace));
}

void add_sound_claims(Figure& figure, const std::string& where, const FixtureRun& run) {
  claim_none(figure, where + ": ticks with a number that is not finite", non_finite_fraction(run.trace));
  claim_none(figure, where + ": ticks in which the HIP was held back without force",
             no_force_fraction(run.trace, kProxyContactRadius_m));
}

Table table_of(const std::string& name, const std::string& title, const std::vector<ColumnName>& columns,
               const std::vector<std::vector<double>>& rows) {
  Table table{name, title};
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::vector<double> values;
    for (const std::vector<double>& row : rows) values.push_back(row.at(c));
    table.add(columns[c].name, columns[c].units, columns[c].long_name, std::move(values));
  }
  return table;
}

void QuantityTable::add(const std::string& quantity, const std::string& unit,
                        const std::vector<double>& of_runs) {
  quantities_.push_back(quantity), units_.push_back(unit);
  for (std::size_t r = 0; r < runs_.size(); ++r) values_[r].push_back(of_runs.at(r));
}

Table QuantityTable::table(const std::string& name, const std::string& title) const {
  Table table{name, title};
  table.columns.push_back({"quantity", "1", "what was measured", quantities_, 1, {}});
  table.columns.push_back({"unit", "1", "unit of the values in this row", units_, 1, {}});
  // The unit changes from row to row.
  for (std::size_t r = 0; r < runs_.size(); ++r) table.add(runs_[r], "1", "value of this run", values_[r]);
  return table;
}

}  // namespace remote_touch
