// A parameter sweep: an experiment, axes along which its parameters change, and the measures of every run.
// Its parts are the axes, what it keeps and refines, shards and cells, and checks of what it states.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_means.h"
#include "analysis/sweeps/sweep_result.h"
#include "analysis/trace/columns.h"
#include "analysis/trace/measures.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

// One axis: its coordinate, and the settings of a run for each value of it.
struct SweepAxis {
  // The dimension scale: numbers, or an enumeration of names. long_name is the path of the parameter, or the
  // paths of all parameters with ", " between them.
  Column coordinate;
  // The settings of a run for each value: paths, as for --set, and values. These are the values of the first
  // round, and those between them that refinement may add.
  std::vector<std::vector<ChangedSetting>> settings;
  std::size_t stride = 1;     // index step between values of the first round
  bool is_joint = false;      // true: a joint axis ("parameters" or "variants"), see read_joint_axis()
  bool common_noise = false;  // true: runs that differ only on this axis have the same noise
  std::string definition;     // complete JSON, as in a file

  std::size_t length() const { return settings.size(); }
  // Returns the paths that the axis sets, each once, in the order in which they appear.
  std::vector<std::string> paths() const;
  // Returns what messages and titles call the axis: its name if it is joint, else the path.
  const std::string& subject() const { return is_joint ? coordinate.name : coordinate.long_name; }
  // Returns one value as a title states it: the subject, and the value or its name.
  ChangedSetting stated(std::size_t i) const;
};

// Reads an axis in one of three forms. label names the axis in InputErrors.
//   {"parameter": PATH, "from": A, "to": B, "count": N, "scale": "linear" or "log"}: refinement may halve
//   the steps `levels` times
//   {"parameter": PATH, "values": [...]}
//   a joint axis: several parameters together, or variants, see read_joint_axis()
// Each form may have "common_noise": true or false.
SweepAxis read_axis(const Json& json, const std::string& label, int levels);

// Returns the definition of an axis with every every-th value. A range becomes the list of these values, or,
// in a sweep with refinement, the range from the first to the last of them.
Json thinned_axis(Json definition, std::size_t every, bool is_refined);

// Returns the dimension scale of values: numbers if each one can be stored as a number, else an enumeration
// of their texts. Throws InputError, about label, for a value that appears twice or is empty.
Column coordinate_of(const std::string& name, const std::string& unit, const std::string& long_name,
                     const std::vector<Json>& values, const std::string& label);

// Returns the unit of the parameter at the path; "1" for a pure number. A parameter's unit ends its name; the
// columns of a list of rows have units of their own.
std::string unit_of_path(const std::string& path);

inline constexpr int kMaxAxisValues = 100000;

// True if the definition is that of a joint axis, which sets several parameters together ("parameters") or
// has named variants ("variants").
bool is_joint(const Json& json);

// Reads a joint axis in one of two forms. label names the axis in InputErrors.
//   {"name": NAME, "unit": UNIT, "parameters": [PATH, ...], "values": [[...], ...], "labels": [...]}
//   Each row of "values" has a value for each parameter. The coordinate is the list of labels, numbers or
//   names; without labels it is the column of the first parameter. "unit" is by default that parameter's.
//   {"name": NAME, "variants": [{"name": ..., "set": {PATH: VALUE, ...}}, ...]}
//   The coordinate is the names. A variant may set nothing; then its runs have the values of the experiment.
// Variants have common noise unless "common_noise" is false. Throws InputError also if two paths of one row
// or variant overlap.
SweepAxis read_joint_axis(const Json& json, const std::string& label);

// The key "keep": what a sweep keeps of its runs.

// runs: the measures of each run. tally: counts, exact sums, extremes and quantiles of each
// cell (analysis/sweeps). events: a tally, and the numbers of the runs in which an event happened.
enum class Keep { runs, tally, events };

// Reads the key "keep" of a sweep; runs if it is missing. Throws InputError for another value, for a sweep
// with refinement that does not keep its runs, and for "events" in a sweep none of whose measures is an event
// (is_event()). label: names the source in errors.
Keep read_keep(const Json& sweep, const std::vector<Measure>& measures, const std::string& label);
const char* name_of(Keep keep);

// The section "refine" of a sweep.

struct RefineSettings {
  std::string measure = "popped_through";
  double threshold = 0.5;
  std::uint64_t budget = 10000;
  int max_replicates = 20;
  int levels = 0;
};

Parameters parameters(RefineSettings& refine);

// Reads the section of a sweep with these measures and replicates. Returns nothing if the sweep has no such
// section. Throws InputError.
std::optional<RefineSettings> read_refine(const Json& sweep, const std::vector<Measure>& measures,
                                          int replicates, const std::string& label);

// The part of a sweep that one process runs: shard `index` of `count`, numbered from 1. Cell c of the first
// round, numbered from 0, belongs to shard c mod count + 1. Neighbouring cells cost nearly the same, so every
// shard has about as many slow cells as the others.
struct Shard {
  int index = 1;
  int count = 1;
  // cells_of() returns how many of the `all` cells of the first round belong to the shard. cell() returns the
  // number of its i-th cell, i from 0, in the order of the first round.
  std::size_t cells_of(std::size_t all) const {
    return (all + static_cast<std::size_t>(count - index)) / static_cast<std::size_t>(count);
  }
  std::size_t cell(std::size_t i) const {
    return i * static_cast<std::size_t>(count) + static_cast<std::size_t>(index) - 1;
  }
  std::string text() const { return std::to_string(index) + "/" + std::to_string(count); }
};

// "2/7". Throws InputError.
Shard parse_shard(const std::string& text);

// Some of the shards of a sweep, in a file that was merged from them.
struct ShardSet {
  std::set<int> indices;
  int count = 1;
  std::string text() const;  // "1-3,7/1000"; "2/7" for one shard
  // The number of runs in these shards of a sweep without refinement.
  std::size_t runs_of(const SweepGrid& grid) const;
};
// Reads what text() returns. Throws InputError, which names the source.
ShardSet parse_shards(const std::string& text, const std::string& source);

// Returns the shard of a Slurm job array (SLURM_ARRAY_TASK_ID, _COUNT, _MIN, _STEP) or of a program started
// by mpirun (OMPI_COMM_WORLD_RANK, _SIZE); none if neither is set. value_of: returns the value of an
// environment variable, null if it is not set, like std::getenv. Throws InputError for values that are not a
// valid shard.
std::optional<Shard> shard_from_environment(const std::function<const char*(const char*)>& value_of);

// Cells of a sweep's grid: those that are checked before the first run, and those of the first round.

inline constexpr std::size_t kMaxChecked = 20000;

// Returns all cells of a grid that has at most kMaxChecked. Of a larger one it returns kMaxChecked cells that
// are spread over the grid, and each cell with one value of an axis and the first values of the others (the
// first kMaxChecked values of an axis). Increasing.
std::vector<std::size_t> checked_cells(const SweepGrid& grid);

// The cells of the first round: all, or with refinement each stride-th along each axis. They are counted from
// 0 in the order of their numbers.
class FirstRound {
 public:
  // Both must exist as long as this object.
  FirstRound(const SweepGrid& grid, const std::vector<SweepAxis>& axes) : grid_(grid), axes_(axes) {}
  std::size_t count() const;
  std::size_t cell(std::size_t number) const;  // the number of the cell in the grid

 private:
  std::size_t nodes(std::size_t axis) const { return (axes_[axis].length() - 1) / axes_[axis].stride + 1; }
  const SweepGrid& grid_;
  const std::vector<SweepAxis>& axes_;
};

// Reads the parts of a sweep's JSON text. label names the source in InputErrors.

// True if the path of the override "key=value" begins with a key of a sweep; it is then not of the
// experiment.
bool is_of_sweep(const std::string& assignment);
// Throws InputError for a key that a sweep does not have.
void refuse_unknown_part(const Json& sweep, const std::string& label);

// Returns the complete experiment, with the settings of "set" and the overrides.
Json read_experiment(const Json& sweep, const std::string& label, const std::vector<std::string>& overrides);
std::vector<SweepAxis> read_axes(const Json& sweep, const std::string& label, int levels);
std::vector<Measure> read_measures(const Json& sweep, const std::string& label);

// Returns a title for a sweep that has none: the title of its experiment, with the axes. That title already
// names the changes of the experiment, so only the changes of the sweep itself are added. Empty if the
// experiment has no title.
std::string title_over(const Json& experiment, const std::vector<ChangedSetting>& changes,
                       const std::vector<SweepAxis>& axes);

// Checks that a result states what was run: no part of a sweep may overwrite what another part states, and
// every run must have the values of its cell.

// Throws InputError, with both paths, if two axes set one parameter, or if a parameter of one contains that
// of another.
void refuse_overlapping(const std::vector<SweepAxis>& axes, const std::string& label);

// Throws InputError, with both paths, if a later statement replaces a value of `set` or of --set. The order
// of the statements is: --set of the sweep's own experiment, `set`, --set, the axes. A --set may replace a
// value of `set`, and an earlier --set, but not the object or list around it. A statement also replaces an
// object if it sets a member that the object has. The elements of a list may be axes, because a list cannot
// be given without them. overrides: all "key=value" of the command line. of_experiment: those that do not
// begin with a key of the sweep. json: the sweep with the other overrides applied.
void refuse_overwritten(const Json& json, const std::vector<std::string>& overrides,
                        const std::vector<std::string>& of_experiment, const std::vector<SweepAxis>& axes,
                        const std::string& label);

// Throws InputError unless the run has the value of an axis in its first tick. If the value is an object, the
// run must have all its members. Null means absent or empty.
void require_run(const Experiment& run, const std::string& axis, const Json& value);

class Sweep {
 public:
  // Reads JSON text: {"title", "experiment", "set", "axes", "replicates", "measures", "refine", "keep"}.
  // label names the source in errors. Overrides "key=value" change the sweep if their path begins with one of
  // its keys, otherwise its experiment; the title names them (changed_settings.h). Cells are resolved and
  // checked: throws InputError for the first cell that cannot be run, and for parts that overwrite each other
  // (refuse_overlapping(), refuse_overwritten()). Of more than 20000 cells, 20000 that are spread over the
  // grid are checked, and those with each value of an axis and the first values of the others.
  static Sweep from_json(const std::string& text, const std::string& label,
                         const std::vector<std::string>& overrides = {});
  // Reads a sweep of data/sweeps by its name, or a JSON file. An error in the text of a file begins with the
  // name of that file; an error in an override does not name a file.
  static Sweep load(const std::string& name_or_file, const std::vector<std::string>& overrides = {});

  const std::string& title() const;
  SweepGrid outline() const;
  // Returns a result without values, whose runs of the first round are pending. That of a shard is a part
  // with its runs of the first round. Throws InputError if it would have more than 1e7 runs, or if the sweep
  // keeps a tally.
  SweepResult plan(const Shard& shard = {}) const;
  // Returns a part that holds these runs, all pending. Throws InputError unless their numbers increase and
  // belong to runs of the sweep.
  SweepResult part(std::vector<std::uint64_t> runs) const;
  // Returns the experiment of one run. It has the values that the result states for its cell; throws
  // InputError otherwise. The noise key contains cell and replicate, so each run has its own noise. For an
  // axis with common noise the key contains the cell of the first value, so runs that differ only on this
  // axis have the same noise.
  Experiment experiment(std::size_t cell, int replicate) const;
  // Throws InputError, with the name of the file, for a stored result with other axes, measures or
  // replicates: none of its runs belongs to this sweep.
  void require_fits(const SweepGrid& stored, const std::string& file) const;
  // Returns the recordings that the checked cells read, each part once, as named in the configuration.
  const std::vector<InputPart>& inputs() const;
  const std::vector<Measure>& measures() const;
  bool needs_true_contact() const;  // true if one of its measures does
  std::optional<RefinementRule> refinement() const;
  Keep keep() const;
  std::string to_json() const;  // complete: read again, it makes the same sweep
  // Returns the sweep with every every-th value of each axis, see thinned_axis(). The runs have other noise
  // than those of the full sweep.
  Sweep thinned(int every) const;

 private:
  struct Definition;
  std::shared_ptr<const Definition> definition_;
};

}  // namespace remote_touch
