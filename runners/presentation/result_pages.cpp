#include "runners/presentation/result_pages.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/sweeps/sweep_file.h"
#include "analysis/trace/contact_measures.h"
#include "analysis/trace/measures.h"
#include "analysis/trace/trace.h"
#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

constexpr std::size_t kMaxSpells = 50;

template <class T>
std::vector<T> values_or_none(const ColumnSource& trace, const std::string& name) {
  if (!trace.has(name)) return {};
  Column column = trace.column(name);
  auto* of_type = std::get_if<std::vector<T>>(&column.values);
  return of_type ? std::move(*of_type) : std::vector<T>{};
}

void find_pop_throughs(const ColumnSource& trace, double held_depth_m, std::vector<TraceEvent>& events) {
  const bool is_measured = trace.has("measured_distance");  // see judged_distance_m()
  const auto distance_m =
      values_or_none<double>(trace, is_measured ? "measured_distance" : "signed_distance");
  const auto frame = values_or_none<std::int32_t>(trace, "frame_index");
  SurfaceSide side(held_depth_m);
  for (std::size_t i = 0; i < distance_m.size(); ++i)
    if ((i >= frame.size() || frame[i] >= 0) && side.add(distance_m[i]))
      events.push_back({i, "pop-through",
                        is_measured ? "The proxy's centre passes behind the measured surface."
                                    : "The proxy's centre passes behind the true surface."});
}

// The first tick at which the column is above zero.
template <class Number>
void find_first(const ColumnSource& trace, const char* column, const char* kind, const char* text,
                std::vector<TraceEvent>& events) {
  const auto values = values_or_none<Number>(trace, column);
  const auto first = std::ranges::find_if(values, [](Number value) { return value > 0; });
  if (first != values.end()) events.push_back({static_cast<std::size_t>(first - values.begin()), kind, text});
}

void find_hardest_hit(const ColumnSource& trace, std::vector<TraceEvent>& events) {
  const auto force_N = values_or_none<double>(trace, "slave_peak_force");
  double largest_N = 0;
  std::size_t tick = 0;
  for (std::size_t i = 0; i < force_N.size(); ++i)
    if (force_N[i] > largest_N) largest_N = force_N[i], tick = i;  // false for NaN
  if (largest_N > 0)
    events.push_back(
        {tick, "hardest hit", formatted("The largest force of the scene on the slave, %.3g N.", largest_N)});
}

void find_largest_forces(const ColumnSource& trace, std::vector<TraceEvent>& events) {
  const auto force_N = values_or_none<double>(trace, "force");
  double largest_N = 0, largest_jump_N = 0;
  std::size_t tick = 0, jump_tick = 0;
  for (std::size_t i = 0; i + 2 < force_N.size(); i += 3) {
    const double size_N = std::hypot(force_N[i], force_N[i + 1], force_N[i + 2]);
    if (size_N > largest_N) largest_N = size_N, tick = i / 3;
    if (i == 0) continue;
    const double jump_N = std::hypot(force_N[i] - force_N[i - 3], force_N[i + 1] - force_N[i - 2],
                                     force_N[i + 2] - force_N[i - 1]);
    if (jump_N > largest_jump_N) largest_jump_N = jump_N, jump_tick = i / 3;
  }
  if (largest_jump_N > 0)
    events.push_back({jump_tick, "force jump",
                      formatted("The largest change of the force, %.3g N in one tick.", largest_jump_N)});
  const char* const format = trace.has("slave_peak_force") ? "The largest force of the renderer, %.3g N."
                                                           : "The largest force, %.3g N.";
  if (largest_N > 0) events.push_back({tick, "largest force", formatted(format, largest_N)});
}

// exhausted: the value of the column that means that the tick did not converge.
void find_spells(const ColumnSource& trace, const std::string& name, std::int32_t exhausted,
                 std::vector<TraceEvent>& events) {
  const auto column = values_or_none<std::int32_t>(trace, name);
  std::size_t found = 0, first_left_out = 0;
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (column[i] != exhausted || (i > 0 && column[i - 1] == exhausted)) continue;
    if (++found == kMaxSpells + 1) first_left_out = i;
    if (found > kMaxSpells) continue;
    std::size_t end = i;
    while (end < column.size() && column[end] == exhausted) ++end;
    events.push_back({i, "not converged",
                      end - i == 1 ? "A tick without convergence."
                                   : std::to_string(end - i) + " ticks without convergence."});
  }
  if (found > kMaxSpells)
    events.push_back({first_left_out, "not converged",
                      "The first of " + std::to_string(found - kMaxSpells) +
                          " more spells without convergence, which are not listed."});
}

std::string name_of_step(std::int32_t step, const std::vector<std::string>& steps) {
  const auto number = static_cast<std::size_t>(std::max(step, 0));
  return "Step " + std::to_string(step) + " of the task" +
         (number < steps.size() ? " (" + steps[number] + ")" : "");
}

// Returns an empty text if the step had no goal.
std::string from_goal(double distance_m, double angle_rad) {
  if (!std::isfinite(distance_m) || !std::isfinite(angle_rad)) return {};
  return formatted(", %.2g mm and %.2g deg from its goal", 1000 * distance_m, angle_rad / kRadiansPerDegree);
}

// Adds the events of the task's steps, with the words that `remote-touch run` prints. If several steps end in
// one tick, only the first can have missed its deadline.
void find_task_steps(const ColumnSource& trace, const std::vector<std::string>& steps,
                     std::vector<TraceEvent>& events) {
  const auto step = values_or_none<std::int32_t>(trace, "sequence_step");
  auto missed = values_or_none<std::int32_t>(trace, "sequence_missed");
  auto running = values_or_none<std::int32_t>(trace, "sequence_running");
  auto distance_m = values_or_none<double>(trace, "sequence_distance");
  auto angle_rad = values_or_none<double>(trace, "sequence_angle");
  missed.resize(step.size()), running.resize(step.size());
  distance_m.resize(step.size(), NAN), angle_rad.resize(step.size(), NAN);
  // Before tick 0 the task is in its step 0, which has not begun.
  std::int32_t step_before = 0, missed_before = 0, running_before = 0;
  for (std::size_t i = 0; i < step.size(); ++i) {
    for (std::int32_t ended = step_before; ended < step[i]; ++ended) {
      const bool is_late = ended == step_before && missed[i] > missed_before;
      events.push_back({i, "task",
                        name_of_step(ended, steps) + (is_late ? " is missed" : " is done") +
                            from_goal(distance_m[i], angle_rad[i]) + "."});
    }
    if (running[i] != 0 && (running_before == 0 || step[i] != step_before))
      events.push_back({i, "task", name_of_step(step[i], steps) + " begins."});
    step_before = step[i], missed_before = missed[i], running_before = running[i];
  }
}

constexpr const char* kColumns[] = {"claim", "paper", "measured", "unit", "criterion", "verdict"};

std::string figure_of(const TextAttributes& run) {
  const auto recipe = recipe_of(run);
  constexpr std::string_view kPrefix = "fig";
  if (!recipe || recipe->action != "run" || !recipe->overrides.empty() ||
      !recipe->subject.starts_with(kPrefix))
    return {};
  return recipe->subject.substr(kPrefix.size());
}

[[noreturn]] void refuse(const std::filesystem::path& file) {
  throw InputError(file.string(), "is not a list of claims: expected the claims.json of remote-touch figure");
}

Json shown(const Json& claim, const std::filesystem::path& file) {
  Json row = Json::object();
  for (const char* column : kColumns) {
    if (!claim.contains(column)) refuse(file);
    row[column] = claim[column];
  }
  return row;
}

class FailedCells {
 public:
  FailedCells(const SweepResult& result, const std::vector<double>& measure, double threshold)
      : result_(result), measure_(measure), threshold_(threshold) {}

  bool has_failed_run(std::size_t cell) const { return counts_of(cell).events > 0; }
  bool at_limit(std::size_t cell) const {
    if (!mostly_failed(cell)) return false;
    for (std::size_t axis = 0; axis < result_.axes.size(); ++axis)
      for (const int way : {-1, 1})
        if (passes_next_to(cell, axis, way)) return true;
    return false;
  }
  std::size_t failed_run(std::size_t cell) const {
    int replicate = 0;
    while (!(measure_[result_.run(cell, replicate)] > threshold_)) ++replicate;
    return result_.run(cell, replicate);
  }

 private:
  EventCounts counts_of(std::size_t cell) const { return event_counts(result_, measure_, cell, threshold_); }
  bool mostly_failed(std::size_t cell) const {
    const EventCounts counts = counts_of(cell);
    return counts.events > counts.without + counts.unknown;
  }
  bool passes_next_to(std::size_t cell, std::size_t axis, int way) const {
    std::vector<std::size_t> indices = result_.axis_indices(cell);
    const std::size_t last = result_.axes[axis].length() - 1;
    while (way < 0 ? indices[axis] > 0 : indices[axis] < last) {
      indices[axis] += static_cast<std::size_t>(way);
      const std::size_t next = result_.cell_at(indices);
      if (counts_of(next).runs() > 0) return !mostly_failed(next);
    }
    return false;
  }

  const SweepResult& result_;
  const std::vector<double>& measure_;
  const double threshold_;
};

std::vector<std::size_t> spread(const std::vector<std::size_t>& all, std::size_t max) {
  if (all.size() <= max) return all;
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < max; ++i)
    some.push_back(all[i * (all.size() - 1) / std::max<std::size_t>(max - 1, 1)]);
  return some;
}

std::vector<std::size_t> extremes(const SweepResult& result, const std::vector<double>& measure) {
  std::vector<std::size_t> done = result.runs_in(RunState::done);
  std::erase_if(done, [&](std::size_t run) { return std::isnan(measure[run]); });
  if (done.empty()) return spread(result.runs_in(RunState::done), 1);
  const auto less = [&](std::size_t a, std::size_t b) { return measure[a] < measure[b]; };
  const auto [low, high] = std::minmax_element(done.begin(), done.end(), less);
  std::vector<std::size_t> both{std::min(*low, *high), std::max(*low, *high)};
  both.erase(std::unique(both.begin(), both.end()), both.end());
  return both;
}

// Reads a sweep. Throws InputError if it is not finished.
StoredSweep finished_sweep(const std::filesystem::path& file) {
  StoredSweep stored = read_stored_sweep(file);
  if (stored.in_progress)
    throw InputError(file.string(), "is not finished: run the same `remote-touch sweep` again until it ends");
  return stored;
}

void require_same_recordings(const StoredSweep& stored, const Sweep& sweep, const std::string& file) {
  for (const ChangedInput& input :
       changed_inputs(attribute(stored.attributes, "input_digests"), input_hashes(sweep.inputs())))
    throw InputError(file, "its recording " + input.path + " has changed: expected " + input.before +
                               ", found " + input.now);
}

Sweep sweep_of(const StoredSweep& stored, const std::string& file) {
  Sweep sweep = read_configuration(stored.attributes, file, [&] {
    return Sweep::from_json(attribute(stored.attributes, "config"), file + " config");
  });
  sweep.require_fits(stored.result, file);
  require_same_recordings(stored, sweep, file);
  return sweep;
}

// The measure that decides whether a run failed, and the value above which it did.
struct Judged {
  std::string measure;
  double threshold = 0.5;
};

Judged judged(const Sweep& sweep, const SweepResult& result) {
  if (const auto refined = sweep.refinement()) return {refined->measure, refined->threshold};
  for (const Column& measure : result.measures)
    if (measure.name == "popped_through") return {measure.name};
  return {result.measures.front().name};
}

// Returns the first failed run among the finished runs of the cell, or the first finished run if none failed.
std::size_t run_of_cell(const SweepResult& result, const std::string& text, const Judged& judged) {
  const std::vector<double>& measure = result.measure(judged.measure);
  const std::size_t begin = result.run(cell_of({"--cells", text}, result), 0);
  std::vector<std::size_t> done;
  for (std::size_t run = begin; run < begin + static_cast<std::size_t>(result.replicates); ++run)
    if (result.state[run] == RunState::done) done.push_back(run);
  if (done.empty()) throw InputError("--cells " + text, "has no finished run");
  const auto failed = std::find_if(done.begin(), done.end(),
                                   [&](std::size_t run) { return measure[run] > judged.threshold; });
  return failed == done.end() ? done.front() : *failed;
}

std::vector<std::size_t> runs_to_show(const SweepResult& result, const std::vector<std::string>& cells,
                                      const Judged& judged) {
  if (cells.empty())
    return default_runs(result, result.measure(judged.measure), judged.threshold, kRunsOfSweepPage);
  std::vector<std::size_t> runs;
  for (const std::string& text : cells) runs.push_back(run_of_cell(result, text, judged));
  std::sort(runs.begin(), runs.end());
  runs.erase(std::unique(runs.begin(), runs.end()), runs.end());
  return runs;
}

std::string name_of(const SweepResult& result, std::size_t run) {
  const std::string cell = "cell " + cell_text(result, result.cell_of(run));
  return result.replicates == 1 ? cell : cell + ", replicate " + std::to_string(result.replicate_of(run));
}

// Compares bit for bit, so a NaN is equal only to a NaN with the same bits.
bool measures_are_stored(const StoredSweep& stored, const Sweep& sweep, std::size_t run, const Trace& trace) {
  for (std::size_t i = 0; i < stored.result.measures.size(); ++i) {
    const double then = std::get<std::vector<double>>(stored.result.measures[i].values)[run];
    const double now = value_of(sweep.measures()[i], trace);
    if (std::bit_cast<std::uint64_t>(now) != std::bit_cast<std::uint64_t>(then)) return false;
  }
  return true;
}

// Returns the attributes of a run: its own configuration and input hashes, and the command and version of its
// sweep. It has no digest.
TextAttributes attributes_of_run(const StoredSweep& stored, const Experiment& experiment) {
  TextAttributes attributes{{"config", experiment.to_json()},
                            {"input_digests", input_hashes(experiment.inputs())}};
  for (const char* name : {"command", "version"})
    attributes.emplace_back(name, attribute(stored.attributes, name));
  return attributes;
}

std::unique_ptr<ShownRun> run_again(const StoredSweep& stored, const Sweep& sweep, std::size_t run,
                                    const ViewOptions& options) {
  const Experiment experiment = sweep.experiment(stored.result.cell_of(run), stored.result.replicate_of(run));
  SimulationOptions simulation;
  simulation.kernels = options.kernels;
  simulation.stop = options.stop;
  simulation.find_true_contact = sweep.needs_true_contact();
  RunReport report;
  simulation.report = &report;
  const Trace trace = simulate(experiment, simulation);
  RunSource source{name_of(stored.result, run), std::make_shared<ColumnsInMemory>(trace.columns()),
                   attributes_of_run(stored, experiment)};
  add_report(source.attributes, report);
  if (!measures_are_stored(stored, sweep, run, trace))
    source.note =
        "This is not the stored run: its measures differ. Another version of the program made the sweep.";
  return std::make_unique<ShownRun>(std::move(source), *options.kernels, options.stop);
}

Json axis_json(const Column& axis) {
  Json values = std::holds_alternative<std::vector<double>>(axis.values)
                    ? Json(std::get<std::vector<double>>(axis.values))
                    : Json(axis.value_names);
  return {{"name", axis.name}, {"unit", axis.units}, {"values", std::move(values)}};
}

// Returns the number of finished runs in each cell.
std::vector<int> done_in_cells(const SweepResult& result) {
  std::vector<int> done(result.cell_count(), 0);
  for (const std::size_t run : result.runs_in(RunState::done)) ++done[result.cell_of(run)];
  return done;
}

// runs: those that the page shows, in the order of its list of runs.
Json map_json(const std::string& file, const std::string& title, const SweepResult& result,
              const std::vector<std::size_t>& runs, const Judged& judged, PackedArrays& numbers) {
  Json map{{"file", file},
           {"title", title},
           {"replicates", result.replicates},
           {"judged", judged.measure},
           {"threshold", judged.threshold},
           {"runs", runs},
           {"done", done_in_cells(result)},
           {"notes", note_lines(result)},
           {"axes", Json::array()},
           {"measures", Json::array()}};
  for (const Column& axis : result.axes) map["axes"].push_back(axis_json(axis));
  for (const Column& measure : result.measures)
    map["measures"].push_back({{"name", measure.name},
                               {"unit", measure.units},
                               {"meaning", measure.long_name},
                               {"numbers", numbers.add(std::get<std::vector<double>>(measure.values))}});
  return map;
}

}  // namespace

std::vector<TraceEvent> trace_events(const ColumnSource& trace, const std::vector<std::string>& steps,
                                     double held_depth_m) {
  std::vector<TraceEvent> events;
  find_pop_throughs(trace, held_depth_m, events);
  find_first<std::int32_t>(trace, "contact_count", "first contact",
                           "The first contact with the measured points.", events);
  find_first<double>(trace, "slave_peak_force", "slave contact",
                     "The slave touches the true surface for the first time.", events);
  find_hardest_hit(trace, events);
  find_largest_forces(trace, events);
  if (trace.has("budget_exhausted"))
    find_spells(trace, "budget_exhausted", 1, events);
  else
    find_spells(trace, "converged", 0, events);
  find_task_steps(trace, steps, events);
  std::stable_sort(events.begin(), events.end(),
                   [](const TraceEvent& a, const TraceEvent& b) { return a.tick < b.tick; });
  return events;
}

Json shown_claims(const std::filesystem::path& claims, const TextAttributes& run) {
  Json list = Json::array();
  if (claims.empty()) return list;
  const Json all =
      parse_json(read_text_file(claims, "expected the claims.json of remote-touch figure"), claims.string());
  if (!all.is_array()) refuse(claims);
  const std::string figure = figure_of(run);
  for (const Json& claim : all) {
    if (!claim.is_object() || !claim.contains("figure")) refuse(claims);
    if (claim["figure"] == figure) list.push_back(shown(claim, claims));
  }
  return list;
}

ViewPage trace_page(const std::vector<std::filesystem::path>& traces, const ViewOptions& options) {
  std::vector<std::unique_ptr<ShownRun>> runs;
  BoundingBox box_W;
  bool has_claims = false;
  for (const auto& file : traces) {
    const auto trace = std::make_shared<StoredTrace>(file);
    RunSource source{file.string(), trace, trace->attributes()};
    const Json claims = shown_claims(options.claims, source.attributes);
    has_claims |= !claims.empty();
    source.claims = claims.dump();
    runs.push_back(std::make_unique<ShownRun>(std::move(source), *options.kernels, options.stop));
    box_W.extend(runs.back()->box_W());
  }
  for (const auto& run : runs) run->set_box(box_W);
  if (runs.size() == 2) runs.front()->mark_divergence_from(*runs.back());
  ViewPage page = view_page(runs.front()->title(), runs, Json::object(), {}, options);
  if (!options.claims.empty() && !has_claims)
    page.shown += options.claims.string() + " has no claim of a figure that runs this experiment\n";
  return page;
}

std::vector<std::size_t> default_runs(const SweepResult& result, const std::vector<double>& measure,
                                      double threshold, std::size_t max) {
  const FailedCells failed(result, measure, threshold);
  std::vector<std::size_t> at_limit, any;
  for (std::size_t cell = 0; cell < result.cell_count(); ++cell) {
    if (!failed.has_failed_run(cell)) continue;
    any.push_back(failed.failed_run(cell));
    if (failed.at_limit(cell)) at_limit.push_back(failed.failed_run(cell));
  }
  if (any.empty()) return spread(extremes(result, measure), max);
  return spread(at_limit.empty() ? any : at_limit, max);
}

ViewPage sweep_page(const std::filesystem::path& file, const std::vector<std::string>& cells,
                    const ViewOptions& options) {
  const StoredSweep stored = finished_sweep(file);
  const Sweep sweep = sweep_of(stored, file.string());
  const Judged by = judged(sweep, stored.result);
  const std::vector<std::size_t> runs = runs_to_show(stored.result, cells, by);
  if (runs.empty()) throw InputError(file.string(), "has no finished run: expected one or more");
  std::vector<std::unique_ptr<ShownRun>> shown;
  for (const std::size_t run : runs) shown.push_back(run_again(stored, sweep, run, options));
  PackedArrays numbers;
  const Json map = map_json(file.filename().string(), sweep.title(), stored.result, runs, by, numbers);
  return view_page(sweep.title(), shown, {{"sweep", map}}, numbers, options);
}

}  // namespace remote_touch
