#include "runners/sweep/sweep_statements.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/parameters/input_error.h"
#include "runners/experiment/settings/changed_settings.h"

namespace remote_touch {

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
