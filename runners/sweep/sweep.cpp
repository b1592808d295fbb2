#include "runners/sweep/sweep.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <functional>
#include <new>
#include <nlohmann/json.hpp>
#include <set>

#include "analysis/sweeps/sweep_tally.h"
#include "analysis/trace/columns.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/simulation/run_notes.h"

namespace remote_touch {
namespace {

constexpr std::size_t kMaxCells = std::size_t{1} << 32;  // the cell is a key of the noise
constexpr std::size_t kMaxRuns = 10'000'000;             // runs in one file
constexpr std::size_t kMaxSweep =
    1'000'000'000'000'000;  // runs in all files: a double holds their numbers exactly

}  // namespace

struct Sweep::Definition {
  std::string title;
  Json experiment;  // complete
  std::vector<SweepAxis> axes;
  SweepGrid grid;  // has the axes
  int replicates = 1;
  std::vector<Measure> measures;
  std::optional<RefineSettings> refine;
  Keep keep = Keep::runs;
  std::vector<InputPart> inputs;  // recordings that the cells read

  // Returns the experiment of one run. It has the values that the result states for its cell.
  Experiment run(std::size_t cell, int replicate) const;
  std::size_t noise_cell(std::vector<std::size_t> indices) const;
  std::string title_of_run(const std::vector<std::size_t>& indices) const;
  void refuse_other_entry(const SweepAxis& axis, const std::string& label) const;
  void refuse_other_parameters(const SweepAxis& axis, const std::string& label) const;
  void check_axes(const std::string& label) const;
  void check_budget(const std::string& label) const;
  void check_cells(const std::string& label);
  int all_replicates() const { return refine ? refine->max_replicates : replicates; }
};

namespace {

// True for a name of a dataset of a tally, or of a variable of its data set in Python.
bool is_of_tally(const std::string& name, const std::vector<Measure>& measures) {
  if (!is_free_in_tallies(name)) return true;
  for (const Measure& measure : measures)
    for (const char* statistic : {"_values", "_mean", "_standard_deviation", "_least", "_greatest"})
      if (name == measure.name + statistic) return true;
  return false;
}

Parameters parameters(std::string& title, int& replicates) {
  return {{"title", &title, 0, 0, "one line that says what this is; shown by list"},
          {"replicates", &replicates, 1, 1e6, "runs of each cell, each with its own noise"}};
}

}  // namespace

Experiment Sweep::Definition::run(std::size_t cell, int replicate) const {
  const std::vector<std::size_t> indices = grid.axis_indices(cell);
  Json json = experiment;
  for (std::size_t i = 0; i < axes.size(); ++i)
    for (const auto& [path, value] : axes[i].settings[indices[i]]) set_value(json, path, value, path);
  json["title"] = title_of_run(indices);
  json["cell"] = noise_cell(indices);
  json["replicate"] = static_cast<std::uint64_t>(replicate);
  Experiment made = Experiment::from_json(json);
  for (std::size_t i = 0; i < axes.size(); ++i)
    for (const auto& [path, value] : axes[i].settings[indices[i]]) require_run(made, path, value);
  return made;
}

// Returns the cell whose noise a run has: the first one on each axis with common noise.
std::size_t Sweep::Definition::noise_cell(std::vector<std::size_t> indices) const {
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (axes[i].common_noise) indices[i] = 0;
  return grid.cell_at(indices);
}

// Returns the title of the experiment with the values of the cell.
std::string Sweep::Definition::title_of_run(const std::vector<std::size_t>& indices) const {
  std::vector<ChangedSetting> changes;
  for (std::size_t i = 0; i < axes.size(); ++i) changes.push_back(axes[i].stated(indices[i]));
  return changed_title(experiment.value("title", std::string()), changes);
}

// Throws InputError for an axis that only changes the name of the renderer, scenario or trajectory. The
// experiment has the settings of its own entry, and another entry may not have them.
void Sweep::Definition::refuse_other_entry(const SweepAxis& axis, const std::string& label) const {
  for (const std::vector<ChangedSetting>& row : axis.settings)
    for (const auto& [path, value] : row) {
      const std::vector<std::string> keys = path_keys(path);
      if (keys.size() != 2 || keys[1] != "name" || !experiment.contains(keys[0])) continue;
      if (const Json* const own = find_value(experiment, keys); own && value != *own)
        throw InputError(label + ": axis " + path + " = " + shown(value),
                         "expected " + std::string(axis.is_joint ? "" : "the axis ") + keys[0] +
                             ", with values like {\"name\": " + shown(value) +
                             "} that may also have settings");
    }
}

// Throws InputError for an axis that sets what is not a parameter of its runs.
void Sweep::Definition::refuse_other_parameters(const SweepAxis& axis, const std::string& label) const {
  for (const std::string& path : axis.paths()) {
    if (path == "cell" || path == "replicate" || path == "title")
      throw InputError(label + ": axis " + path, "set by the sweep: expected another parameter");
    if (const std::string section = path_keys(path).front(); section == "live" || section == "safety")
      throw InputError(label + ": axis " + path,
                       "only live runs use section " + section + ": expected another parameter");
  }
}

void Sweep::Definition::check_axes(const std::string& label) const {
  std::set<std::string> names = {"replicate", "run", "state", "notes", "round", "error", "checksum"};
  for (const Measure& measure : measures) names.insert(measure.name);
  auto runs = static_cast<std::size_t>(all_replicates());
  for (const SweepAxis& axis : axes) {
    refuse_other_parameters(axis, label);
    refuse_other_entry(axis, label);
    const std::string& name = axis.coordinate.name;
    if (!names.insert(name).second)
      throw InputError(label + ": axis " + axis.subject(),
                       "another axis or measure has the name " + name + ": expected different names");
    if (keep != Keep::runs && is_of_tally(name, measures))
      throw InputError(label + ": axis " + axis.subject(),
                       "a part of the tally has the name " + name + ": expected another name");
    if (__builtin_mul_overflow(runs, axis.length(), &runs) || runs > kMaxSweep)
      throw InputError(
          label, "more than " + std::to_string(kMaxSweep) + " runs: expected fewer values or replicates");
  }
  if (runs / static_cast<std::size_t>(all_replicates()) > kMaxCells)
    throw InputError(label, "more than " + std::to_string(kMaxCells) + " cells: expected fewer values");
}

void Sweep::Definition::check_budget(const std::string& label) const {
  if (!refine) return;
  const auto first_round = static_cast<std::uint64_t>(replicates) * FirstRound(grid, axes).count();
  if (refine->budget < first_round)
    throw InputError(label + ": refine.budget = " + std::to_string(refine->budget),
                     "expected at least the " + std::to_string(first_round) + " runs of the first round");
}

// Checks the cells in parallel, because a large map has many. The error names the first wrong cell in order.
// Collects the recordings that they read.
void Sweep::Definition::check_cells(const std::string& label) {
  const std::vector<std::size_t> checked = checked_cells(grid);
  const auto cells = static_cast<long>(checked.size());
  long first_wrong = cells;
  std::string problem;
  std::atomic<bool> lacks_memory{false};  // not a problem of a cell
  std::set<InputPart> parts;
#pragma omp parallel for schedule(static, 64)
  for (long i = 0; i < cells; ++i) {
    try {
      const auto read = run(checked[static_cast<std::size_t>(i)], 0).inputs();
      if (read.empty()) continue;
#pragma omp critical(sweep_inputs)
      parts.insert(read.begin(), read.end());
    } catch (const std::bad_alloc&) {
      lacks_memory = true;
    } catch (const std::exception& error) {
#pragma omp critical(sweep_check)
      if (i < first_wrong) first_wrong = i, problem = error.what();
    }
  }
  if (lacks_memory) throw std::bad_alloc();
  inputs.assign(parts.begin(), parts.end());
  if (first_wrong == cells) return;
  std::string where;
  for (const std::size_t k : grid.axis_indices(checked[static_cast<std::size_t>(first_wrong)]))
    where.append(where.empty() ? "" : ",").append(std::to_string(k));
  throw InputError(label + ": cell " + where, problem);
}

Sweep Sweep::from_json(const std::string& text, const std::string& label,
                       const std::vector<std::string>& overrides) {
  Json json = parse_json(text, label);
  if (!json.is_object())
    throw InputError(label, "not an object: expected {\"experiment\": ..., \"axes\": [...]}");
  refuse_discarded(overrides);
  const std::vector<ChangedSetting> changes = changes_of(json, overrides);
  std::vector<std::string> of_experiment;
  for (const std::string& assignment : overrides)
    if (is_of_sweep(assignment))
      apply_override(json, assignment);
    else
      of_experiment.push_back(assignment);

  refuse_unknown_part(json, label);

  auto definition = std::make_shared<Definition>();
  Json plain = json;
  for (const char* part : {"experiment", "set", "axes", "measures", "refine", "keep"}) plain.erase(part);
  read_parameters(plain, parameters(definition->title, definition->replicates), "");
  definition->measures = read_measures(json, label);
  definition->keep = read_keep(json, definition->measures, label);
  definition->refine = read_refine(json, definition->measures, definition->replicates, label);
  definition->axes = read_axes(json, label, definition->refine ? definition->refine->levels : 0);
  refuse_overlapping(definition->axes, label);
  refuse_overwritten(json, overrides, of_experiment, definition->axes, label);
  definition->experiment = read_experiment(json, label, of_experiment);
  definition->title = definition->title.empty()
                          ? title_over(definition->experiment, changes, definition->axes)
                          : changed_title(definition->title, changes);
  if (definition->title.empty()) definition->title = label;
  definition->check_axes(label);
  for (const SweepAxis& axis : definition->axes) definition->grid.axes.push_back(axis.coordinate);
  definition->check_budget(label);
  definition->check_cells(label);
  Sweep sweep;
  sweep.definition_ = std::move(definition);
  return sweep;
}

Sweep Sweep::load(const std::string& name_or_file, const std::vector<std::string>& overrides) {
  const std::string text = embedded_or_file(embedded_sweeps(), name_or_file, "a sweep's");
  const auto read = [&](const std::vector<std::string>& settings) {
    return from_json(text, name_or_file, settings);
  };
  return is_stored(embedded_sweeps(), name_or_file) ? read(overrides)
                                                    : with_file_in_refusal(name_or_file, overrides, read);
}

const std::string& Sweep::title() const {
  return definition_->title;
}

SweepGrid Sweep::outline() const {
  SweepGrid result = definition_->grid;
  result.replicates = definition_->all_replicates();
  for (const Measure& measure : definition_->measures)
    result.measures.push_back({measure.name, measure.unit, measure.meaning, {}, 1, {}});
  result.note_kinds = note_kind_names();
  return result;
}

SweepResult Sweep::part(std::vector<std::uint64_t> runs) const {
  SweepResult result(outline());
  if (std::adjacent_find(runs.begin(), runs.end(), std::greater_equal<>()) != runs.end() ||
      (!runs.empty() && runs.back() >= result.run_count()))
    throw InputError(title(),
                     "expected increasing numbers of its " + std::to_string(result.run_count()) + " runs");
  result.part = std::move(runs);
  result.start(false);
  result.state.assign(result.held_count(), RunState::pending);
  return result;
}

SweepResult Sweep::plan(const Shard& shard) const {
  if (keep() != Keep::runs)
    throw InputError(title(), std::string("keeps a tally (keep = ") + name_of(keep()) +
                                  "): expected keep = runs, or the command sweep");
  SweepResult result(outline());
  const FirstRound first(result, definition_->axes);
  const std::size_t held =
      shard.count > 1 ? shard.cells_of(first.count()) * static_cast<std::size_t>(definition_->replicates)
                      : result.run_count();
  if (held > kMaxRuns)
    throw InputError(title(), std::to_string(held) + " runs in one file: expected at most " +
                                  std::to_string(kMaxRuns) + "; use more shards (--shard)");
  std::vector<std::uint64_t> runs;
  for (std::size_t i = 0; i < shard.cells_of(first.count()); ++i)
    for (int replicate = 0; replicate < definition_->replicates; ++replicate)
      runs.push_back(result.run(first.cell(shard.cell(i)), replicate));
  if (shard.count > 1) result.part = runs;
  result.start(definition_->refine.has_value());
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::size_t place = result.part ? i : static_cast<std::size_t>(runs[i]);
    result.state[place] = RunState::pending;
    if (!result.round.empty()) result.round[place] = 0;
  }
  return result;
}

Experiment Sweep::experiment(std::size_t cell, int replicate) const {
  return definition_->run(cell, replicate);
}

void Sweep::require_fits(const SweepGrid& stored, const std::string& file) const {
  const auto is_axis = [](const Column& a, const Column& b) {
    return a.long_name == b.long_name && a.values == b.values && a.value_names == b.value_names;
  };
  const auto is_measure = [](const Column& a, const Measure& b) { return a.name == b.name; };
  const std::vector<Column>& axes = definition_->grid.axes;
  if (!std::equal(axes.begin(), axes.end(), stored.axes.begin(), stored.axes.end(), is_axis))
    throw InputError(file, "damaged (its axes are not those of its configuration)");
  if (stored.replicates != definition_->all_replicates() ||
      !std::equal(stored.measures.begin(), stored.measures.end(), measures().begin(), measures().end(),
                  is_measure))
    throw InputError(file, "damaged (its arrays do not fit its configuration)");
}

const std::vector<InputPart>& Sweep::inputs() const {
  return definition_->inputs;
}

const std::vector<Measure>& Sweep::measures() const {
  return definition_->measures;
}

bool Sweep::needs_true_contact() const {
  return std::any_of(measures().begin(), measures().end(), remote_touch::needs_true_contact);
}

std::optional<RefinementRule> Sweep::refinement() const {
  if (!definition_->refine) return std::nullopt;
  const RefineSettings& refine = *definition_->refine;
  RefinementRule rule{refine.measure, refine.threshold, refine.budget, definition_->replicates, {}};
  for (const SweepAxis& axis : definition_->axes) rule.strides.push_back(axis.stride);
  return rule;
}

Keep Sweep::keep() const {
  return definition_->keep;
}

std::string Sweep::to_json() const {
  Json json = {{"title", definition_->title}, {"experiment", definition_->experiment}};
  for (const SweepAxis& axis : definition_->axes)
    json["axes"].push_back(parse_json(axis.definition, axis.subject()));
  json["replicates"] = definition_->replicates;
  for (const Measure& measure : definition_->measures) json["measures"].push_back(measure.name);
  if (definition_->keep != Keep::runs) json["keep"] = name_of(definition_->keep);
  if (definition_->refine) {
    RefineSettings refine = *definition_->refine;
    json["refine"] = Json::object();
    write_parameters(parameters(refine), json["refine"]);
  }
  return json.dump();
}

Sweep Sweep::thinned(int every) const {
  Json json = parse_json(to_json(), title());
  for (Json& axis : json["axes"])
    axis = thinned_axis(axis, static_cast<std::size_t>(every), json.contains("refine"));
  return from_json(json.dump(), title());
}

}  // namespace remote_touch
