// Random sweeps whose parts may overwrite each other. Each is refused, or its runs have what it states. Code
// other than the program's checks this.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "runners/sweep/sweep.h"
#include "tests/support/test_files.h"

namespace remote_touch::random_sweeps_test {
namespace {

using Plain = nlohmann::json;

struct Choice {
  const char* path;
  std::vector<const char*> values;
};

// Parts of fig4.12 of all kinds, some of which contain others.
const Choice kChoices[] = {
    {"scenario.noise_sigma_m", {"0", "0.001", "0.0025"}},
    {"scenario.acceleration_m_per_s2", {"1", "20", "3.5"}},
    {"scenario.columns", {"60", "80.0"}},
    {"scenario",
     {R"({"name": "moving-lift", "noise_sigma_m": 0.002})", R"({"name": "moving-lift", "columns": 50})",
      R"({"name": "flat-grid"})", R"({"name": "moving-lift"})"}},
    {"renderer.stiffness_N_per_m", {"300", "500", "600"}},
    {"renderer.velocity_estimate", {"true", "false"}},
    {"renderer.step_rule", {"\"fixed\"", "\"variable\""}},
    {"renderer", {R"({"name": "proxy", "stiffness_N_per_m": 400})", R"({"name": "proxy"})"}},
    {"trajectory.start_m", {"[0, 0, 0]", "[0, 0.01, 0]"}},
    {"trajectory.start_m.1", {"0.02", "0.03"}},
    {"seed", {"7", "18446744073709551615", "9007199254740993"}},
    {"haptic_rate_hz", {"900", "1000"}},
    {"faults", {"null", R"({"dropout_probability": 0.25})"}},
    {"faults.dropout_probability", {"0.5", "0.125"}},
};

bool is_within(const std::string& inner, const std::string& outer) {
  return (inner + ".").starts_with(outer + ".");
}

struct Statement {
  std::string path, value;
};

// rows: for each value what it sets; a range has none. paths: those of all rows.
struct RandomAxis {
  std::vector<std::vector<Statement>> rows;
  std::vector<std::string> paths;
  bool is_joint = false;

  void add(const std::vector<Statement>& row) {
    rows.push_back(row);
    for (const Statement& each : row) paths.push_back(each.path);
  }
  // True if no row sets a parameter twice.
  bool has_disjoint_rows() const {
    for (const std::vector<Statement>& row : rows)
      for (const Statement& a : row)
        for (const Statement& b : row)
          if (&a != &b && is_within(a.path, b.path)) return false;
    return true;
  }
};

struct RandomSweep {
  std::vector<RandomAxis> axes;
  std::vector<Statement> set, options;
  bool has_changes = false;
  std::string text;

  // True if no two of its parts overlap.
  bool is_disjoint() const {
    std::vector<std::vector<std::string>> parts;
    for (const RandomAxis& axis : axes) {
      if (!axis.has_disjoint_rows()) return false;
      parts.push_back(axis.paths);
    }
    for (const Statement& each : set) parts.push_back({each.path});
    for (const Statement& each : options) parts.push_back({each.path});
    for (std::size_t i = 0; i < parts.size(); ++i)
      for (std::size_t j = 0; j < parts.size(); ++j)
        for (const std::string& a : parts[i])
          for (const std::string& b : parts[j])
            if (i != j && is_within(a, b)) return false;
    return !has_changes;
  }
  std::vector<std::string> overrides() const {
    std::vector<std::string> list;
    for (const Statement& each : options) list.push_back(each.path + "=" + each.value);
    return list;
  }
};

class Chance {
 public:
  explicit Chance(unsigned seed) : random_(seed) {}
  std::size_t below(std::size_t count) { return random_() % count; }

  Statement statement() {
    const Choice& choice = kChoices[below(std::size(kChoices))];
    return {choice.path, choice.values[below(choice.values.size())]};
  }
  Plain axis(RandomAxis& made) {
    const std::size_t kind = below(4);
    made.is_joint = kind < 2;
    return kind == 0 ? parameters_axis(made) : kind == 1 ? variants_axis(made) : plain_axis(made);
  }
  RandomSweep sweep() {
    RandomSweep made;
    Plain json = {{"experiment", "fig4.12"}, {"measures", {"mean_steps"}}, {"set", Plain::object()}};
    for (std::size_t i = below(3) + 1; i > 0; --i) {
      json["axes"].push_back(axis(made.axes.emplace_back()));
      if (json["axes"].back().contains("name")) json["axes"].back()["name"] = "axis" + std::to_string(i);
    }
    for (std::size_t i = below(3); i > 0; --i) {
      const Statement each = statement();
      if (json["set"].contains(each.path)) continue;
      json["set"][each.path] = Plain::parse(each.value), made.set.push_back(each);
    }
    if (below(4) == 0) made.options.push_back(statement());
    made.has_changes = below(6) == 0;
    if (made.has_changes)
      json["set"]["changes"] =
          Plain::parse(R"([{"time_s": 0, "parameter": "renderer.stiffness_N_per_m", "value": 500}])");
    made.text = json.dump();
    return made;
  }

 private:
  Plain plain_axis(RandomAxis& made) {
    const Choice& choice = kChoices[below(std::size(kChoices))];
    std::vector<const char*> list;
    for (const char* value : choice.values)
      if (list.size() < 2 || below(2) == 0) list.push_back(value);
    std::shuffle(list.begin(), list.end(), random_);
    if (&choice == kChoices && below(2) == 0) {
      made.paths.emplace_back(choice.path);
      return {{"parameter", choice.path}, {"from", 0.001}, {"to", 0.004}, {"count", 1 + below(3)}};
    }
    Plain values = Plain::array();
    for (const char* value : list) made.add({{choice.path, value}}), values.push_back(Plain::parse(value));
    return {{"parameter", choice.path}, {"values", values}};
  }
  Plain parameters_axis(RandomAxis& made) {
    const Statement first = statement(), second = statement();
    const Plain values = {Plain::parse(first.value), Plain::parse(second.value)};
    made.add({first, second});
    return {{"name", ""},
            {"parameters", {first.path, second.path}},
            {"values", Plain::array({values})},
            {"labels", {below(2) == 0 ? Plain(0.5) : Plain("both")}}};
  }
  Plain variants_axis(RandomAxis& made) {
    Plain variants = Plain::array();
    for (const char* const name : {"a", "b"}) {
      std::vector<Statement> row;
      Plain set = Plain::object();
      for (std::size_t i = below(2) + 1; i > 0; --i) {
        const Statement each = statement();
        if (set.contains(each.path)) continue;
        set[each.path] = Plain::parse(each.value), row.push_back(each);
      }
      made.add(row);
      variants.push_back({{"name", name}, {"set", set}});
    }
    return {{"name", ""}, {"variants", variants}};
  }

  std::mt19937 random_;
};

// Returns the configuration with the changes that come before the first tick.
Plain at_start(Plain configuration, const Experiment& experiment) {
  for (const RendererChange& change : experiment.changes())
    if (change.time_s == 0) configuration["renderer"][change.parameter.substr(9)] = change.value;
  return configuration;
}

// True if adding the stated part to what is run changes nothing.
bool has(const Plain& run, std::string path, const Plain& stated) {
  std::replace(path.begin(), path.end(), '.', '/');
  const Plain::json_pointer place("/" + path);
  const Plain there = run.contains(place) ? run[place] : Plain();
  Plain merged = there;
  merged.merge_patch(stated);
  return stated.is_null() ? there.is_null() : merged == there;
}

// Returns the value of a cell as the file has it.
Plain stated_by(const Column& axis, std::size_t row) {
  if (const auto* numbers = std::get_if<std::vector<double>>(&axis.values)) return (*numbers)[row];
  const Plain value = Plain::parse(axis.value_names[row], nullptr, false);
  return value.is_discarded() ? Plain(axis.value_names[row]) : value;
}

// Checks also what the user set, except what an option replaced. An option that is a part of a list replaces
// it in part.
void expect_true(const RandomSweep& made, const Sweep& sweep) {
  const SweepResult plan = sweep.plan();
  for (std::size_t cell = 0; cell < plan.cell_count(); ++cell) {
    const Experiment experiment = sweep.experiment(cell, 0);
    const Plain configuration = Plain::parse(experiment.to_json());
    const Plain run = at_start(configuration, experiment);
    for (std::size_t i = 0; i < plan.axes.size(); ++i) {
      const std::size_t row = plan.axis_indices(cell)[i];
      for (const auto& [path, value] :
           made.axes[i].rows.empty() ? std::vector<Statement>() : made.axes[i].rows[row])
        EXPECT_TRUE(has(run, path, Plain::parse(value))) << made.text << " cell " << cell << " axis " << i;
      if (made.axes[i].is_joint) continue;  // the file has names of their own
      EXPECT_TRUE(has(run, plan.axes[i].long_name, stated_by(plan.axes[i], row)))
          << made.text << " cell " << cell << " axis " << i;
    }
    const auto expect_kept = [&](const Statement& statement, const std::vector<std::string>& later) {
      for (const std::string& path : later)
        if (is_within(path, statement.path) || is_within(statement.path, path)) return;
      EXPECT_TRUE(has(configuration, statement.path, Plain::parse(statement.value)))
          << made.text << " cell " << cell << " sets " << statement.path;
    };
    const std::string element = "trajectory.start_m.1";
    for (const Statement& each : made.options) expect_kept(each, {element});
    std::vector<std::string> options = {element};
    for (const Statement& each : made.options) options.push_back(each.path);
    for (const Statement& each : made.set) expect_kept(each, options);
  }
}

TEST(Statements, RandomSweepsAreRefusedOrRunWhatTheyState) {
  Chance chance(20261126);
  int accepted = 0, overlapping = 0;
  for (int i = 0; i < 500; ++i) {
    const RandomSweep made = chance.sweep();
    std::optional<Sweep> sweep;
    const std::string problem =
        refusal([&] { sweep.emplace(Sweep::from_json(made.text, "random", made.overrides())); });
    if (sweep) {
      ++accepted;
      expect_true(made, *sweep);
      continue;
    }
    EXPECT_FALSE(made.is_disjoint()) << made.text << ": " << problem;
    const bool is_named = std::any_of(made.axes.begin(), made.axes.end(), [&](const RandomAxis& axis) {
      return std::any_of(axis.paths.begin(), axis.paths.end(),
                         [&](const std::string& path) { return problem.find(path) != std::string::npos; });
    });
    overlapping += is_named;
  }
  EXPECT_GT(accepted, 100);
  EXPECT_GT(overlapping, 100);
}

}  // namespace
}  // namespace remote_touch::random_sweeps_test
