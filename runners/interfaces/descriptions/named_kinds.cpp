#include <nlohmann/json.hpp>

#include "core/dissertation/tool/shape/generated_tools.h"
#include "core/parameters/input_error.h"
#include "runners/evaluation/figures/figures.h"
#include "runners/evaluation/scorecard/benchmark.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/catalog/sections.h"
#include "runners/experiment/settings/embedded_data.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/interfaces/descriptions/descriptions.h"

namespace remote_touch {

namespace {

void add_sections(std::vector<NamedKind>& all) {
  NamedKind& sections = all.emplace_back(NamedKind{"sections", {}});
  for (const auto& section : experiment_sections()) sections.rows.push_back({section.key, section.summary});
  for (const auto& section : experiment_sections()) {
    if (!section.heading) continue;
    NamedKind& kind = all.emplace_back(NamedKind{section.heading, {}});
    for (const auto& entry : section.entries()) kind.rows.push_back({entry.name, entry.summary});
  }
}

}  // namespace

std::string summary_of(const Measure& measure) {
  return measure.meaning + "; unit: " + measure.unit + "; " + text_of(measure.better) + "; " +
         name_of(measure.runs);
}

std::vector<NamedKind> named_kinds() {
  std::vector<NamedKind> all;
  add_sections(all);
  const auto add = [&all](const char* name) -> auto& {
    return all.emplace_back(NamedKind{name, {}}).rows;
  };
  auto& experiments = add("experiments");
  for (const auto& stored : embedded_experiments())
    experiments.push_back({stored.name, Experiment::load(stored.name).settings().title});
  auto& sweeps = add("sweeps");
  for (const auto& stored : embedded_sweeps())  // not loaded, because loading checks every cell
    sweeps.push_back({stored.name, parse_json(stored.json, stored.name).at("title").get<std::string>()});
  auto& methods = add("methods");
  for (const Method& method : chosen_methods({})) methods.push_back({method.name, method.title});
  auto& scenes = add("scenes");
  for (const BenchmarkScene& scene : chosen_scenes({})) scenes.push_back({scene.name, scene.title});
  auto& tools = add("tools");
  for (const GeneratedTool& tool : generated_tools()) tools.push_back({tool.name, tool.summary});
  auto& drawn = add("figures");
  for (const auto& entry : figures()) drawn.push_back({entry.name, entry.summary});
  auto& numbers = add("measures");
  for (const auto& measure : measures()) numbers.push_back({measure.name, summary_of(measure)});
  return all;
}

NamedKind named_kind(const std::string& name) {
  std::string known;
  for (NamedKind& kind : named_kinds()) {
    if (kind.kind == name) return std::move(kind);
    known.append(known.empty() ? "" : ", ").append(kind.kind);
  }
  throw InputError(name, "is not a kind: expected " + known);
}

}  // namespace remote_touch
