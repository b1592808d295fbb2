#include "runners/presentation/descriptions.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "core/mesh/triangle_mesh.h"
#include "core/parameters/parameter.h"
#include "runners/evaluation/figures/figure_recipe.h"
#include "runners/evaluation/scorecard/benchmark.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/catalog/configuration.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/mesh_files/loaded_tool.h"
#include "runners/experiment/mesh_files/mesh_file.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/sweep/sweep.h"

namespace remote_touch {
namespace {

// An entry to which the first name of the path leads.
struct Owner {
  std::string name, section;
  std::unique_ptr<Configurable> settings;
};

std::vector<Owner> owners_of(const std::string& name) {
  std::vector<Owner> owners;
  for (const ExperimentSection& section : experiment_sections())
    for (const SectionEntry& entry : section.entries()) {
      if (name.empty() || (name != section.key && name != entry.name)) continue;
      owners.push_back({entry.name.empty() ? section.key : entry.name, section.key, entry.make()});
    }
  return owners;
}

// Pure numbers, and columns without a unit, have no such text.
std::string unit_text(std::string_view unit) {
  std::string text;
  if (!unit.empty() && unit != "1") text.append("unit ").append(unit).append("; ");
  return text;
}

std::string column_text(const std::string& name) {
  std::vector<std::string> known;
  for (const TraceColumn& column : trace_columns()) {
    known.emplace_back(column.name);
    if (name != column.name) continue;
    std::string text = "trace." + name + ": a column of a trace: " + meaning_of(column) + "\n";
    if (std::string_view(column.meaning) != column.meaning_with_tool)
      text += std::string("  with a tool: ") + column.meaning_with_tool + "\n";
    return text + "  " + unit_text(column.unit) + std::to_string(column.width) + " in each row; in " +
           runs_with(column.part) + "\n";
  }
  refuse_key(name, known, "trace.");
}

std::string allowed_text(const Parameter& parameter) {
  return "default " + value_text(parameter) + "; allowed " + allowed(parameter) +
         (parameter.is_live ? "; live\n" : "\n");
}

// Returns the parameter of a path, once for every entry that has it:
//   proxy.r1_m, run.seed    of an entry of a catalog, or of a section
//   renderer.r1_m           of every renderer that has it, as in --set
//   fixtures.0.radius_m     the same for a list
//   trace.force             a column of a trace
// Empty if no section and no entry has the first name. Throws InputError, with the most similar name, if it
// has no such parameter.
std::string parameter_text(const std::string& path) {
  const std::vector<std::string> keys = path_keys(path);
  const bool in_list = keys.size() == 3 && is_index(keys[1]);
  if (keys.size() != 2 && !in_list) return {};
  if (keys[0] == "trace" && !in_list) return column_text(keys[1]);
  std::vector<std::string> known;
  std::string text;
  const std::vector<Owner> owners = owners_of(keys.front());
  for (const Owner& owner : owners)
    for (const Parameter& parameter : owner.settings->settings()) {
      known.push_back(parameter.name);
      if (parameter.name != keys.back()) continue;
      const Unit* unit = unit_of(parameter.name);
      text += owner.name + "." + parameter.name + ": a parameter of \"" + owner.section +
              "\": " + parameter.help + "\n  " + unit_text(unit ? unit->text : "") + allowed_text(parameter);
    }
  if (text.empty() && !owners.empty()) refuse_key(keys.back(), known, keys.front() + ".");
  return text;
}

std::string json_text(const std::string& json, const std::string& name) {
  return parse_json(json, name).dump(2) + "\n";
}

std::string text_of(const Parameters& parameters) {
  std::string text;
  for (const Parameter& p : parameters)
    text += formatted("  %-24s %s\n  %-24s ", p.name.c_str(), p.help.c_str(), "") + allowed_text(p);
  return text;
}

// Returns the entries of the section's catalog, or the parameters of a section without a catalog.
std::string section_text(const std::string& name) {
  std::string text;
  for (const ExperimentSection& section : experiment_sections()) {
    if (name != section.key) continue;
    text += name + ": \"" + name + "\" of an experiment: " + section.summary + "\n";
    for (const SectionEntry& entry : section.entries())
      text += section.heading ? formatted("  %-24s %s\n", entry.name.c_str(), entry.summary.c_str())
                              : text_of(entry.make()->settings());
  }
  return text;
}

// Searches the catalogs of all sections: a scenario and a trajectory may have the same name.
std::string entry_text(const std::string& name) {
  std::string text;
  for (const ExperimentSection& section : experiment_sections())
    for (const SectionEntry& entry : section.entries())
      if (!name.empty() && name == entry.name)  // a section without a catalog has a nameless entry
        text += name + ": a \"" + section.key + "\" of an experiment: " + entry.summary + "\n" +
                text_of(entry.make()->settings());
  return text;
}

std::string experiment_text(const std::string& name) {
  for (const EmbeddedText& stored : embedded_experiments()) {
    if (name != stored.name) continue;
    const Experiment experiment = Experiment::load(name);
    return name + ": an experiment: " + experiment.settings().title + "\n" +
           json_text(experiment.to_json(), name) +
           "Parameters of the run itself; those of its sections: remote-touch describe SECTION\n" +
           section_text("run");
  }
  return {};
}

std::string sweep_text(const std::string& name) {
  for (const EmbeddedText& stored : embedded_sweeps()) {
    if (name != stored.name) continue;
    const Sweep sweep = Sweep::load(name);
    const SweepGrid outline = sweep.outline();
    const std::size_t runs =
        sweep.keep() == Keep::runs ? sweep.plan().runs_in(RunState::pending).size() : outline.run_count();
    std::string text =
        name + ": a sweep: " + sweep.title() + "\n" + json_text(sweep.to_json(), name) +
        formatted("Axes: %zu cells; %zu runs in the first round\n", outline.cell_count(), runs);
    for (const Column& axis : outline.axes)
      text +=
          formatted("  %-24s %zu values of %s\n", axis.name.c_str(), axis.length(), axis.long_name.c_str());
    return text;
  }
  return {};
}

std::string method_text(const std::string& name) {
  for (const Method& method : chosen_methods({}))
    if (name == method.name)
      return name + ": a method of the scorecard: " + method.title + "\n" + json_text(method.renderer, name);
  return {};
}

std::string scene_text(const std::string& name) {
  for (const BenchmarkScene& scene : chosen_scenes({})) {
    if (name != scene.name) continue;
    std::string text =
        name + ": a scene of the scorecard: " + scene.title + "\n" + json_text(scene.experiment, name) +
        "Noise: " + (scene.noise.empty() ? "its own" : scene.noise) + "\nSuccess: " + scene.meaning + "\n";
    for (const Bound& bound : scene.success)
      text += formatted("Bound: %s within %g .. %g\n", bound.measure.c_str(), bound.min, bound.max);
    return text;
  }
  return {};
}

// Returns what the renderers make of a built-in tool or a mesh file in metres by default. Empty if the name
// is neither.
std::string tool_text(const std::string& name) {
  const GeneratedTool* built_in = find_generated_tool(name);
  if (built_in == nullptr && !is_mesh_file(name)) return {};
  LoadedSpheres::Settings settings;
  settings.tool.mesh = name;
  std::string report;
  load_tool_of_spheres(settings.tool, settings.leaves, &report);
  return name + ": a tool: " + (built_in ? built_in->summary : "from a mesh file") + "\n" + report + "\n";
}

// Returns the columns that a run stores, in the order of the file.
std::string trace_text(const std::string& name) {
  if (name != "trace") return {};
  std::string text =
      "trace: what a run records, one row for each tick. For each column: unit, numbers per row, meaning:\n";
  std::optional<TracePart> part;
  for (const TraceColumn& column : trace_columns()) {
    if (part != column.part) text += std::string("In ") + runs_with(column.part) + ":\n";
    part = column.part;
    text += formatted("  %-24s %-4s x %d  %s\n", column.name, column.unit, column.width,
                      meaning_of(column).c_str());
    if (std::string_view(column.meaning) != column.meaning_with_tool)
      text += formatted("  %-24s            with a tool: %s\n", "", column.meaning_with_tool);
  }
  return text;
}

// Tests read the time and --quick from this line, so that they keep no list of slow figures of their own.
std::string figure_text(const std::string& name) {
  const auto is_it = [&](const FigureEntry& entry) { return name == entry.name; };
  const auto entry = std::find_if(figures().begin(), figures().end(), is_it);
  if (entry == figures().end()) return {};
  const std::string text = formatted("%s: a figure: %s; about %g s on one fast core", entry->name,
                                     entry->summary, entry->expected_s);
  return text +
         (entry->quick_coarse > 1
              ? formatted("; --quick uses one in %d values of each axis of its map\n", entry->quick_coarse)
              : "\n");
}

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

std::string meaning_of(const TraceColumn& column) {
  std::string meaning = column.meaning;
  for (std::size_t i = 0; i < column.value_names.size(); ++i)
    meaning.append(i == 0 ? ": " : ", ").append(std::to_string(i)).append(" ").append(column.value_names[i]);
  return meaning;
}

const char* runs_with(TracePart part) {
  switch (part) {
    case TracePart::always:
      break;
    case TracePart::tool:
      return "a run with a tool";
    case TracePart::guidance:
      return "a run with guidance or a sequence";
    case TracePart::replay:
      return "a run that replays a known contact";
    case TracePart::measured_surface:
      return "a run with a measured surface beside the true one";
    case TracePart::slave:
      return "a run with a slave";
    case TracePart::channel_energy:
      return "a run whose hand is to feel the slave";
    case TracePart::slave_tool:
      return "a run with a slave that has a tool";
    case TracePart::rounded_hand:
      return "a run whose device rounds the pose of the hand";
    case TracePart::hand:
      return "a run with an operator or a device";
  }
  return "every run";
}

std::string described(const std::string& name) {
  std::string text;
  for (const auto of_kind : {section_text, entry_text, experiment_text, sweep_text, method_text, scene_text,
                             trace_text, tool_text, figure_text})
    text += of_kind(name);
  for (const Measure& measure : measures())
    if (name == measure.name) text += name + ": a measure: " + summary_of(measure) + "\n";
  if (text.empty()) text = parameter_text(name);
  if (!text.empty()) return text;
  throw InputError(
      name, "unknown: expected a name from `remote-touch list`, or NAME.PARAMETER, such as proxy.r1_m");
}

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
