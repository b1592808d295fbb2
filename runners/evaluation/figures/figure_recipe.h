// The figures that can be reproduced, and what they are written with: the runs of their experiments, tables
// by their columns, panels of curves, and claims.
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
#include "analysis/trace/trace.h"
#include "core/points/vector.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep.h"
#include "runners/sweep/work_pool.h"

namespace remote_touch {

// r_c of every figure of chapters 4 and 5: Table 4.2.
inline constexpr double kContactRadius_m = 0.005;

// Runs the experiments of a figure. Independent runs are made in parallel; results do not depend on the
// number of threads.
class FigureContext {
 public:
  // coarse: uses every coarse-th value of the axes of maps, for a preview; 1: all.
  FigureContext(const Kernels& kernels, const std::atomic<bool>* stop, int coarse = 1,
                SideBySide runs = side_by_side)
      : kernels_(kernels), stop_(stop), coarse_(coarse), runs_(std::move(runs)) {}

  Trace run(const Experiment& experiment);
  Trace run(const std::string& experiment, const std::vector<std::string>& overrides = {}) {
    return run(Experiment::load(experiment, overrides));
  }
  // Records an experiment whose frames are used without a run.
  void uses(const Experiment& experiment) {
    note(experiment.to_json());
    inputs_.add(experiment.inputs());
  }
  const Kernels& kernels() const { return kernels_; }
  // Returns work(i) for each i below count, in parallel. For work that is not a run; uses() records what it
  // reads.
  template <class Work>
  auto collect(std::size_t count, Work&& work) const {
    std::vector<decltype(work(std::size_t{}))> results(count);
    runs_(count, [&](std::size_t i) { results[i] = work(i); });
    return results;
  }
  std::vector<Trace> run(const std::vector<Experiment>& experiments);  // parallel runs
  // Returns of(trace) for each run, in parallel. The first failure is thrown after all runs have ended.
  template <class Of>
  auto measure(const std::vector<Experiment>& experiments, Of&& of) {
    if (!experiments.empty()) note(experiments.front().to_json());
    for (const Experiment& experiment : experiments) inputs_.add(experiment.inputs());
    return collect(experiments.size(), [&](std::size_t i) { return of(simulated(experiments[i])); });
  }
  // Returns a stored sweep of thousands of runs, thinned by `coarse`, for the calls of sweep() and measure()
  // below.
  Sweep map(const std::string& name, const std::vector<std::string>& overrides = {});
  // Number of runs of the full maps, and number of runs that are made, over all calls of map().
  std::size_t runs_of_maps() const { return runs_of_maps_; }
  std::size_t made_runs_of_maps() const { return made_runs_of_maps_; }
  // Makes every run of a sweep; throws InputError if one failed.
  SweepResult sweep(const Sweep& sweep);
  // Returns of(trace) for each run of a sweep's plan, in its order.
  template <class Of>
  auto measure(const Sweep& sweep, Of&& of) {
    const SweepResult plan = sweep.plan();
    note(sweep.to_json());
    inputs_.add(sweep.inputs());
    return collect(plan.run_count(), [&](std::size_t run) {
      return of(simulated(sweep.experiment(plan.cell_of(run), plan.replicate_of(run))));
    });
  }
  // Returns the resolved configuration of every run(), uses() and sweep, and of the first experiment of every
  // measure() of experiments, as a JSON list.
  std::string configurations() const;
  // Returns the hashes of the recordings that all of them read, see provenance.h.
  std::string inputs() const { return inputs_.text(); }
  void require_unchanged_inputs() const { inputs_.require_unchanged(); }
  // Returns the counts of the notes on all runs, one line for each kind.
  std::vector<std::string> note_lines() const { return notes_.lines(); }

 private:
  // Several threads call it at the same time: of the members it changes only notes_, which has a lock.
  Trace simulated(const Experiment& experiment);
  void note(const std::string& configuration) { configurations_.push_back(configuration); }

  std::vector<std::string> configurations_;
  InputHashes inputs_;
  NoteCounts notes_;
  const Kernels& kernels_;
  const std::atomic<bool>* stop_;
  int coarse_;
  SideBySide runs_;
  std::size_t runs_of_maps_ = 0, made_runs_of_maps_ = 0;
};

// A run of a figure that has several: its name in tables, and a label for readers.
struct NamedExperiment {
  std::string name, label, experiment;
  std::vector<std::string> overrides = {};
};
struct NamedRun {
  std::string name, label;
  Experiment experiment;
  Trace trace;
};
std::vector<NamedRun> named_runs(FigureContext& context, const std::vector<NamedExperiment>& experiments);

// Returns a measure of the runs of a sweep with these places on its axes, in order; an axis without a place
// may have any.
std::vector<double> measured(const SweepResult& sweep, const std::string& measure,
                             const std::vector<std::optional<std::size_t>>& places);

// The values of a numeric axis of a sweep, and the one that a cell has.
inline const std::vector<double>& axis_values(const SweepResult& sweep, std::size_t axis) {
  return std::get<std::vector<double>>(sweep.axes.at(axis).values);
}
inline double axis_value(const SweepResult& sweep, std::size_t axis, std::size_t cell) {
  return axis_values(sweep, axis).at(sweep.axis_indices(cell).at(axis));
}

// Makes a figure. May throw InputError: the figure is then reported as not run.
using MakeFigure = Figure(FigureContext& context);

struct FigureEntry {
  const char* name;
  const char* summary;
  MakeFigure* make;
  double expected_s;     // time on one thread, for the order of figures and the time left
  bool has_map = false;  // the map needs most of that time
  int quick_coarse = 1;  // value of coarse for a quick figure
};
std::span<const FigureEntry> figures();

// A run with forbidden regions, and what its figure compares it with.
struct FixtureRun {
  Trace trace;
  std::unique_ptr<Scenario> scenario;  // scenario of the run, for its ground truth
  std::vector<double> radius_m;        // r_f of the frame in use in each tick

  // Capture time of the frame that the renderer has in tick i.
  double frame_captured_s(std::size_t i) const { return scenario->captured_s(trace.frame_index[i]); }
  // Correct distance of the proxy's centre from the surface, r_f + r_c.
  double boundary_m(std::size_t i) const { return radius_m[i] + kContactRadius_m; }
};

// Runs the experiments in parallel. pre: every point has the same r_f, and no scene ends before its run.
std::vector<FixtureRun> run_fixtures(FigureContext& context, const std::vector<Experiment>& experiments);

struct ColumnName {
  std::string name, units, long_name;
};
// Each row has one number for every column.
using TableRows = std::vector<std::vector<double>>;
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
// Returns make(element) for each element of a list, such as the experiment of each value of a setting.
template <class List, class Make>
auto list_of(const List& list, Make&& make) {
  std::vector<decltype(make(*std::begin(list)))> made;
  for (const auto& element : list) made.push_back(make(element));
  return made;
}
// Returns whole numbers, such as counts, as numbers.
template <class Whole>
Numbers doubles(const std::vector<Whole>& values) {
  return {values.begin(), values.end()};
}
double most(const std::vector<std::int32_t>& counts);  // the largest count; NaN without counts
Numbers norms(const std::vector<Vec3>& vectors);
Numbers norms_between(const std::vector<Vec3>& a, const std::vector<Vec3>& b);  // of a - b
Numbers along(int axis, const std::vector<Vec3>& vectors);                      // components: x is 0
Numbers minus(Numbers values, const Numbers& others);                           // pre: as many others
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
  for (const ColumnOver<Element>& column : columns)
    table.add(column.name, column.units, column.long_name, each(elements, column.value));
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
  Table table{
      name,
      title,
      {{"quantity", "1", "what was measured", rows}, {"unit", "1", "unit of the values in this row", units}}};
  for (std::size_t r = 0; r < runs.size(); ++r)  // the unit changes from row to row
    table.add(names.at(r), "1", "value of this run",
              each(quantities, [&](const Quantity<Run>& quantity) { return quantity.of(runs[r]); }));
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
               const std::string& paper = "-") const {
    add(claim_at_most(figure_.name, opening_ + claim, paper, measured, limit, unit));
  }
  void at_least(const std::string& claim, double measured, double limit, const std::string& unit,
                const std::string& paper = "-") const {
    add(claim_at_least(figure_.name, opening_ + claim, paper, measured, limit, unit));
  }
  void between(const std::string& claim, double measured, double low, double high, const std::string& unit,
               const std::string& paper = "-") const {
    add(claim_between(figure_.name, opening_ + claim, paper, measured, low, high, unit));
  }
  void differs(const std::string& claim, double measured, double low, double high, const std::string& unit,
               const std::string& paper = "-") const {
    add(claim_differs(figure_.name, opening_ + claim, paper, measured, low, high, unit));
  }

 private:
  void add(Claim claim) const;

  Figure& figure_;
  std::string opening_;
  bool Claim::*mark_;
};

// Claims that all numbers of a run are finite.
void claim_finite(const Claims& claims, const Trace& trace, const std::string& paper = "-");
// Adds the claim that the proxy is never behind the surface. where: what the text begins with.
void add_side_claim(Figure& figure, const std::string& where, const Trace& trace);
// Adds the claims that all numbers are finite and that there is no force dropout.
void add_sound_claims(Figure& figure, const std::string& where, const Trace& trace);

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
