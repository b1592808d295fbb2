#include "runners/sweep/sweep.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/parameters/parameter.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {

const char* name_of(Keep keep) {
  return keep == Keep::runs ? "runs" : keep == Keep::tally ? "tally" : "events";
}

Keep read_keep(const Json& sweep, const std::vector<Measure>& measures, const std::string& label) {
  const auto found = sweep.find("keep");
  if (found == sweep.end()) return Keep::runs;
  for (const Keep keep : {Keep::runs, Keep::tally, Keep::events}) {
    if (*found != name_of(keep)) continue;
    if (keep != Keep::runs && sweep.contains("refine"))
      throw InputError(label + ": keep = " + name_of(keep),
                       "refinement needs the values of all runs: expected runs, or a sweep without refine");
    const auto is_of_event = [](const Measure& each) {
      return is_event({each.name, each.unit, each.meaning, {}});
    };
    if (keep == Keep::events && std::none_of(measures.begin(), measures.end(), is_of_event))
      throw InputError(label + ": keep = events",
                       "none of the measures is an event: expected one such as popped_through, or tally");
    return keep;
  }
  throw InputError(label + ": keep = " + found->dump(), "expected runs, tally or events");
}

Parameters parameters(RefineSettings& r) {
  return {
      {"measure", &r.measure, 0, 0, "measure that defines the event"},
      {"threshold", &r.threshold, -1e12, 1e12, "the event happens when the measure is above this"},
      {"budget", &r.budget, 1, 1e7, "maximum number of runs, including the first round"},
      {"max_replicates", &r.max_replicates, 1, 100000, "maximum number of replicates of a cell"},
      {"levels", &r.levels, 0, 10, "how many times the spacing of the axes may be halved"},
  };
}

std::optional<RefineSettings> read_refine(const Json& json, const std::vector<Measure>& chosen,
                                          int replicates, const std::string& label) {
  const auto found = json.find("refine");
  if (found == json.end() || found->is_null()) return std::nullopt;
  RefineSettings refine;
  read_parameters(*found, parameters(refine), "refine");
  const auto is_it = [&](const Measure& measure) { return refine.measure == measure.name; };
  if (std::none_of(chosen.begin(), chosen.end(), is_it))
    throw InputError(label + ": refine.measure = \"" + refine.measure + "\"",
                     "expected one of the sweep's measures");
  if (refine.max_replicates < replicates)
    throw InputError(label + ": refine.max_replicates", "expected at least replicates");
  return refine;
}

namespace {

constexpr int kMaxShards = 1000000;

std::optional<int> integer_value(const std::string& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// Returns the value of a variable as an integer; nothing if it is not set or empty. Throws InputError for
// other texts.
std::optional<int> integer_variable(const char* name, const char* text) {
  if (text == nullptr || *text == '\0') return std::nullopt;
  const auto value = integer_value(text);
  if (!value || *value < 0) throw InputError(std::string(name) + " = " + text, "expected integers from 0");
  return value;
}

Shard checked(int index, int count, const std::string& source) {
  if (count < 1 || count > kMaxShards || index < 1 || index > count)
    throw InputError(source, "expected i/N with 1 <= i <= N <= " + std::to_string(kMaxShards));
  return {index, count};
}

// Returns the integers of "3" or "1-3" as a range; {0, 0} for other texts.
std::pair<int, int> range_of(const std::string& text) {
  const std::size_t dash = text.find('-');
  const auto first = integer_value(text.substr(0, dash));
  const auto last = dash == std::string::npos ? first : integer_value(text.substr(dash + 1));
  return {first.value_or(0), last.value_or(0)};
}

}  // namespace

std::string ShardSet::text() const {
  std::string text;
  for (auto at = indices.begin(); at != indices.end();) {
    const int first = *at;
    int last = first;
    for (++at; at != indices.end() && *at == last + 1; ++at) last = *at;
    text +=
        (text.empty() ? "" : ",") + std::to_string(first) + (last > first ? "-" + std::to_string(last) : "");
  }
  return text + "/" + std::to_string(count);
}

std::size_t ShardSet::runs_of(const SweepGrid& grid) const {
  std::size_t cells = 0;
  for (const int index : indices) cells += Shard{index, count}.cells_of(grid.cell_count());
  return cells * static_cast<std::size_t>(grid.replicates);
}

ShardSet parse_shards(const std::string& text, const std::string& source) {
  const std::string what = source + ": shard " + text;
  const std::size_t slash = text.find('/');
  ShardSet set;
  set.count = slash == std::string::npos ? 0 : integer_value(text.substr(slash + 1)).value_or(0);
  for (std::size_t at = 0; at <= std::min(slash, text.size());) {
    const std::size_t end = std::min({text.find(',', at), slash, text.size()});
    const auto [first, last] = range_of(text.substr(at, end - at));
    checked(first, set.count, what), checked(last, set.count, what);
    for (int i = first; i <= last; ++i) set.indices.insert(i);
    at = end + 1;
  }
  return set;
}

Shard parse_shard(const std::string& text) {
  const auto slash = text.find('/');
  const auto index = integer_value(text.substr(0, slash));
  const auto count = slash == std::string::npos ? std::nullopt : integer_value(text.substr(slash + 1));
  return checked(index.value_or(0), count.value_or(0), "--shard " + text);
}

std::optional<Shard> shard_from_environment(const std::function<const char*(const char*)>& value_of) {
  const auto variable = [&](const char* name) { return integer_variable(name, value_of(name)); };
  if (const auto id = variable("SLURM_ARRAY_TASK_ID")) {
    const auto count = variable("SLURM_ARRAY_TASK_COUNT");
    if (!count) return std::nullopt;
    const int first = variable("SLURM_ARRAY_TASK_MIN").value_or(0);
    const int step = variable("SLURM_ARRAY_TASK_STEP").value_or(1);
    const int index = (*id - first) / std::max(1, step) + 1;
    return checked(index, *count, "SLURM_ARRAY_TASK_ID = " + std::to_string(*id));
  }
  const auto rank = variable("OMPI_COMM_WORLD_RANK"), size = variable("OMPI_COMM_WORLD_SIZE");
  if (!rank || !size) return std::nullopt;
  return checked(*rank + 1, *size, "OMPI_COMM_WORLD_RANK = " + std::to_string(*rank));
}

std::vector<std::size_t> checked_cells(const SweepGrid& grid) {
  const std::size_t all = grid.cell_count(), spread = std::min(all, kMaxChecked);
  std::vector<std::size_t> cells;
  for (std::size_t i = 0; i < spread; ++i)
    cells.push_back(static_cast<std::size_t>(static_cast<unsigned __int128>(i) * all / spread));
  if (spread == all) return cells;
  cells.push_back(all - 1);
  for (std::size_t axis = 0; axis < grid.axes.size(); ++axis)
    for (std::size_t i = 1; i < std::min(grid.axes[axis].length(), kMaxChecked); ++i) {
      std::vector<std::size_t> indices(grid.axes.size(), 0);
      indices[axis] = i;
      cells.push_back(grid.cell_at(indices));
    }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

std::size_t FirstRound::count() const {
  std::size_t count = 1;
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) count *= nodes(axis);
  return count;
}

std::size_t FirstRound::cell(std::size_t number) const {
  std::vector<std::size_t> indices(axes_.size());
  for (std::size_t axis = axes_.size(); axis-- > 0; number /= nodes(axis))
    indices[axis] = number % nodes(axis) * axes_[axis].stride;
  return grid_.cell_at(indices);
}

namespace {

const std::vector<std::string> kParts = {"title",      "experiment", "set",    "axes",
                                         "replicates", "measures",   "refine", "keep"};

// Returns the path of an experiment that a sweep file names. A file in the folder of the sweep file comes
// first.
std::string beside(const std::string& sweep_file, const std::string& experiment) {
  const auto there = std::filesystem::path(sweep_file).parent_path() / experiment;
  std::error_code unreachable;
  return std::filesystem::is_regular_file(there, unreachable) ? there.string() : experiment;
}

}  // namespace

bool is_of_sweep(const std::string& assignment) {
  const std::string key = assignment.substr(0, assignment.find_first_of(".="));
  return std::find(kParts.begin(), kParts.end(), key) != kParts.end();
}

void refuse_unknown_part(const Json& json, const std::string& label) {
  for (const auto& item : json.items())
    if (!is_of_sweep(item.key()))
      throw InputError(label + ": " + item.key(), "unknown: expected " + joined(kParts, ", "));
}

Json read_experiment(const Json& json, const std::string& label, const std::vector<std::string>& overrides) {
  const auto found = json.find("experiment");
  if (found == json.end() || !(found->is_string() || found->is_object()))
    throw InputError(label + ": experiment", "missing: expected a name, a file or an experiment itself");
  std::vector<std::string> settings;
  if (const auto set = json.find("set"); set != json.end()) {
    if (!set->is_object()) throw InputError(label + ": set", "expected {\"path\": value, ...}");
    for (const auto& item : set->items()) settings.push_back(item.key() + "=" + item.value().dump());
  }
  settings.insert(settings.end(), overrides.begin(), overrides.end());
  const Experiment experiment = found->is_string()
                                    ? Experiment::load(beside(label, found->get<std::string>()), settings)
                                    : Experiment::from_json(found->dump(), label + ": experiment", settings);
  if (experiment.settings().key.cell != 0 || experiment.settings().key.replicate != 0)
    throw InputError(label + ": experiment", "cell and replicate are set by the sweep: expected 0");
  return parse_json(experiment.to_json(), label);
}

std::string title_over(const Json& experiment, const std::vector<ChangedSetting>& changes,
                       const std::vector<SweepAxis>& axes) {
  const std::string title = experiment.value("title", std::string());
  if (title.empty()) return title;
  std::vector<ChangedSetting> of_sweep;
  for (const ChangedSetting& change : changes)
    if (is_of_sweep(change.first)) of_sweep.push_back(change);
  std::string over;
  for (const SweepAxis& axis : axes) over += (over.empty() ? ", over " : " and ") + axis.subject();
  return changed_title(title, of_sweep) + over;
}

std::vector<SweepAxis> read_axes(const Json& json, const std::string& label, int levels) {
  const auto found = json.find("axes");
  if (found == json.end() || !found->is_array() || found->empty() || found->size() > 8)
    throw InputError(label + ": axes", "expected a list of 1 to 8 axes");
  std::vector<SweepAxis> axes;
  for (std::size_t i = 0; i < found->size(); ++i)
    axes.push_back(read_axis((*found)[i], label + ": axes." + std::to_string(i), levels));
  return axes;
}

std::vector<Measure> read_measures(const Json& json, const std::string& label) {
  const auto found = json.find("measures");
  if (found == json.end()) return {measures().begin(), measures().end()};
  std::vector<Measure> chosen;
  std::vector<std::string> names;
  for (const Measure& measure : measures()) names.push_back(measure.name);
  const auto refuse = [&](const std::string& what) {
    throw InputError(label + ": measures",
                     what + ": expected a list of different names of " + joined(names, ", "));
  };
  if (!found->is_array() || found->empty()) refuse("not a list");
  for (const Json& name : *found) {
    const auto is_it = [&](const Measure& measure) { return name == measure.name; };
    const auto measure = std::find_if(measures().begin(), measures().end(), is_it);
    if (measure == measures().end()) refuse(name.dump() + " is unknown");
    if (std::any_of(chosen.begin(), chosen.end(), is_it)) refuse(name.dump() + " appears twice");
    chosen.push_back(*measure);
  }
  return chosen;
}

namespace {

using Keys = std::vector<std::string>;

bool is_within(const Keys& inner, const Keys& outer) {
  return outer.size() <= inner.size() && std::equal(outer.begin(), outer.end(), inner.begin());
}

// A value that the user sets. Statements are applied in this order.
struct Statement {
  enum class Of { option_of_own_experiment, set, option, axis };
  Of of;
  std::string subject;  // subject of an error about this statement
  std::string name;     // name in an error about another statement
  Keys keys;
  Json value;  // null for an axis: nothing is applied after it
};

// True if the value has a member at these keys, below its own. An element of a list does not count as a
// statement of its own.
bool has_member(const Json& value, std::span<const std::string> keys) {
  const Json* const object = find_value(value, keys.first(keys.size() - 1));
  return object && object->is_object() && object->contains(keys.back());
}

bool overwrites(const Statement& later, const Statement& earlier) {
  if (is_within(earlier.keys, later.keys)) return true;
  if (!is_within(later.keys, earlier.keys)) return false;
  if (earlier.value.is_null()) return true;  // null states that there is nothing
  return has_member(earlier.value, std::span(later.keys).subspan(earlier.keys.size()));
}

// A --set may replace a value of `set`, or an earlier --set. It may not replace the object or list around
// another value, unless that keeps the value. A --set that discards another one is found before, see
// refuse_discarded().
bool may_overwrite(const Statement& later, const Statement& earlier) {
  using Of = Statement::Of;
  if (earlier.of == later.of) return later.of != Of::set;
  if (earlier.of != Of::set || later.of != Of::option) return false;
  if (later.keys.size() >= earlier.keys.size()) return true;
  const Json* const kept = find_value(later.value, std::span(earlier.keys).subspan(later.keys.size()));
  return kept && *kept == earlier.value;
}

Statement option(Statement::Of of, const std::string& assignment, const std::string& begin) {
  auto [path, value] = read_assignment(assignment.substr(begin.size()));
  const std::string name = "--set " + begin + path;
  return {of, name + "=" + shown(value), name, normalised_keys(path), std::move(value)};
}

// Returns "the axis renderer.r1_m", or "the axis r_c (renderer.r1_m)" of a joint axis.
std::string name_of(const SweepAxis& axis, const std::string& path) {
  return "the axis " + axis.subject() + (axis.is_joint ? " (" + path + ")" : std::string());
}

std::vector<Statement> statements_of(const Json& json, const std::vector<std::string>& overrides,
                                     const std::vector<std::string>& of_experiment,
                                     const std::vector<SweepAxis>& axes, const std::string& label) {
  using Of = Statement::Of;
  const std::string own = "experiment.";
  std::vector<Statement> all;
  for (const std::string& assignment : overrides)
    if (assignment.starts_with(own)) all.push_back(option(Of::option_of_own_experiment, assignment, own));
  if (const auto set = json.find("set"); set != json.end() && set->is_object())
    for (const auto& item : set->items())
      all.push_back({Of::set, label + ": set." + item.key(), "set." + item.key(), normalised_keys(item.key()),
                     item.value()});
  for (const std::string& assignment : of_experiment) all.push_back(option(Of::option, assignment, ""));
  for (const SweepAxis& axis : axes)
    for (const std::string& path : axis.paths())
      all.push_back({Of::axis, "", name_of(axis, path), normalised_keys(path), {}});
  return all;
}

bool is_empty(const Json& value) {
  return value.is_null() || (value.is_array() && value.empty());
}

// A stated value that differs from the value in the run.
struct Contradiction {
  std::string path;
  const Json& stated;
  Json run;
};

// Returns the first value at or below the path that differs in the run. It is not a whole object, which may
// be too long to show the difference.
std::optional<Contradiction> contradiction(const std::string& path, const Json& stated, const Json& run) {
  const bool are_lists = stated.is_array() && run.is_array() && stated.size() == run.size();
  if (!are_lists && !(stated.is_object() && run.is_object())) {
    if (stated.is_null() ? is_empty(run) : stated == run) return std::nullopt;
    return Contradiction{path, stated, run};
  }
  for (const auto& [key, value] : stated.items()) {
    const Json member = are_lists ? run[std::stoul(key)] : run.value(key, Json());
    if (auto found = contradiction(path + "." + key, value, member)) return found;
  }
  return std::nullopt;
}

}  // namespace

void refuse_overlapping(const std::vector<SweepAxis>& axes, const std::string& label) {
  std::vector<std::pair<std::size_t, std::string>> earlier;  // axis and path
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::vector<std::string> paths = axes[i].paths();
    for (const std::string& path : paths)
      for (const auto& [other, other_path] : earlier) {
        const Keys a = normalised_keys(other_path), b = normalised_keys(path);
        if (!is_within(a, b) && !is_within(b, a)) continue;
        throw InputError(label + ": axes." + std::to_string(i) + " " + path,
                         "overlaps axes." + std::to_string(other) + " " + other_path +
                             ": expected each parameter once, and none that contains another");
      }
    for (const std::string& path : paths) earlier.emplace_back(i, path);
  }
}

void refuse_overwritten(const Json& json, const std::vector<std::string>& overrides,
                        const std::vector<std::string>& of_experiment, const std::vector<SweepAxis>& axes,
                        const std::string& label) {
  const std::vector<Statement> all = statements_of(json, overrides, of_experiment, axes, label);
  for (std::size_t later = 0; later < all.size(); ++later)
    for (std::size_t i = 0; i < later; ++i)
      if (!may_overwrite(all[later], all[i]) && overwrites(all[later], all[i]))
        throw InputError(all[i].subject, "is overwritten by " + all[later].name + ": expected one of them");
}

void require_run(const Experiment& run, const std::string& axis, const Json& value) {
  if (const auto found = contradiction(axis, value, run.value_at_start(axis)))
    throw InputError("axis " + found->path + " = " + shown(found->stated),
                     "the run has " + shown(found->run) + ": expected a value that nothing else changes");
}

}  // namespace remote_touch
