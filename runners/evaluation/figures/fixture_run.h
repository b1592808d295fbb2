// A run of chapter 5's protocol: its trace, the current fixture radius, and the claims that hold for any such
// run.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runners/evaluation/figures/figures.h"

namespace remote_touch {

inline constexpr double kProxyContactRadius_m = 0.005;

struct FixtureRun {
  Trace trace;
  std::unique_ptr<Scenario> scenario;  // scenario of the run, for its ground truth
  std::vector<double> radius_m;        // r_f of the frame in use in each tick

  // Capture time of the frame that the renderer has in tick i.
  double frame_captured_s(std::size_t i) const { return scenario->captured_s(trace.frame_index[i]); }
  // Correct distance of the proxy's centre from the surface, r_f + r_c.
  double boundary_m(std::size_t i) const { return radius_m[i] + kProxyContactRadius_m; }
};

// Runs the experiments in parallel. pre: every point has the same r_f, and no scene ends before its run.
std::vector<FixtureRun> run_fixtures(const FigureContext& context,
                                     const std::vector<Experiment>& experiments);

// Adds the claim that the proxy is never behind the surface.
void add_side_claim(Figure& figure, const std::string& where, const FixtureRun& run);
// Adds the claims that all numbers are finite and that there is no force dropout.
void add_sound_claims(Figure& figure, const std::string& where, const FixtureRun& run);

// Returns a table from its rows; each row has one number for every column.
struct ColumnName {
  const char *name, *units, *long_name;
};
Table table_of(const std::string& name, const std::string& title, const std::vector<ColumnName>& columns,
               const std::vector<std::vector<double>>& rows);

// Named numbers of several runs, a column for each run.
class QuantityTable {
 public:
  explicit QuantityTable(std::vector<std::string> runs) : runs_(std::move(runs)), values_(runs_.size()) {}
  // One value for each run.
  void add(const std::string& quantity, const std::string& unit, const std::vector<double>& of_runs);
  Table table(const std::string& name, const std::string& title) const;

 private:
  std::vector<std::string> runs_, quantities_, units_;
  std::vector<std::vector<double>> values_;
};

}  // namespace remote_touch
