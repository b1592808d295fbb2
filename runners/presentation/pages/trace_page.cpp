#include "runners/presentation/pages/trace_page.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/trace/contact_measures.h"
#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "runners/experiment/settings/provenance.h"
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
  std::size_t found = 0;
  for (std::size_t i = 0; i < column.size() && found < kMaxSpells; ++i)
    if (column[i] == exhausted && (i == 0 || column[i - 1] != exhausted)) {
      std::size_t end = i;
      while (end < column.size() && column[end] == exhausted) ++end;
      events.push_back({i, "not converged",
                        end - i == 1 ? "A tick without convergence."
                                     : std::to_string(end - i) + " ticks without convergence."});
      ++found;
    }
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

namespace {

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

}  // namespace

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

}  // namespace remote_touch
