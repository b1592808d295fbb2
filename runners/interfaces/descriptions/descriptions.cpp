#include "runners/interfaces/descriptions/descriptions.h"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "core/dissertation/tool/shape/generated_tools.h"
#include "core/parameters/input_error.h"
#include "core/parameters/parameter.h"
#include "runners/evaluation/figures/figures.h"
#include "runners/evaluation/scorecard/benchmark.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/catalog/sections.h"
#include "runners/experiment/mesh_files/mesh_file.h"
#include "runners/experiment/settings/embedded_data.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/tool_files/loaded_tool.h"
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

void print(const Owner& owner, const Parameter& parameter, std::FILE* out) {
  const Unit* unit = unit_of(parameter.name);
  std::fprintf(out, "%s.%s: a parameter of \"%s\": %s\n  %sdefault %s; allowed %s%s\n", owner.name.c_str(),
               parameter.name.c_str(), owner.section.c_str(), parameter.help.c_str(),
               unit_text(unit ? unit->text : "").c_str(), value_text(parameter).c_str(),
               allowed(parameter).c_str(), parameter.is_live ? "; live" : "");
}

void describe_column(const std::string& name, std::FILE* out) {
  std::vector<std::string> known;
  for (const TraceColumn& column : trace_columns()) {
    known.emplace_back(column.name);
    if (name != column.name) continue;
    std::fprintf(out, "trace.%s: a column of a trace: %s\n", column.name, meaning_of(column).c_str());
    if (std::string_view(column.meaning) != column.meaning_with_tool)
      std::fprintf(out, "  with a tool: %s\n", column.meaning_with_tool);
    std::fprintf(out, "  %s%d in each row; in %s\n", unit_text(column.unit).c_str(), column.width,
                 runs_with(column.part));
    return;
  }
  refuse_key(name, known, "trace.");
}

}  // namespace

bool describe_parameter(const std::string& path, std::FILE* out) {
  const std::vector<std::string> keys = path_keys(path);
  const bool in_list = keys.size() == 3 && is_index(keys[1]);
  if (keys.size() != 2 && !in_list) return false;
  if (keys[0] == "trace" && !in_list) return describe_column(keys[1], out), true;
  std::vector<std::string> known;
  bool found = false;
  const std::vector<Owner> owners = owners_of(keys.front());
  for (const Owner& owner : owners)
    for (const Parameter& parameter : owner.settings->settings()) {
      known.push_back(parameter.name);
      if (parameter.name != keys.back()) continue;
      print(owner, parameter, out);
      found = true;
    }
  if (!found && !owners.empty()) refuse_key(keys.back(), known, keys.front() + ".");
  return found;
}

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

namespace {

void print(const Parameters& parameters, std::FILE* out) {
  for (const Parameter& p : parameters)
    std::fprintf(out, "  %-24s %s\n  %-24s default %s; allowed %s%s\n", p.name.c_str(), p.help.c_str(), "",
                 value_text(p).c_str(), allowed(p).c_str(), p.is_live ? "; live" : "");
}

// Prints the entries of the section's catalog, or the parameters of a section without a catalog.
void print_section(const ExperimentSection& section, std::FILE* out) {
  for (const SectionEntry& entry : section.entries())
    if (section.heading)
      std::fprintf(out, "  %-24s %s\n", entry.name.c_str(), entry.summary.c_str());
    else
      print(entry.make()->settings(), out);
}

bool describe_section(const std::string& name, std::FILE* out) {
  for (const ExperimentSection& section : experiment_sections()) {
    if (name != section.key) continue;
    std::fprintf(out, "%s: \"%s\" of an experiment: %s\n", section.key, section.key, section.summary);
    print_section(section, out);
    return true;
  }
  return false;
}

// Searches the catalogs of all sections: a scenario and a trajectory may have the same name. Prints every
// entry that has it. Returns false if there is none.
bool describe_entry(const std::string& name, std::FILE* out) {
  bool found = false;
  for (const ExperimentSection& section : experiment_sections())
    for (const SectionEntry& entry : section.entries()) {
      if (name.empty() || name != entry.name) continue;  // a section without a catalog has a nameless entry
      std::fprintf(out, "%s: a \"%s\" of an experiment: %s\n", name.c_str(), section.key,
                   entry.summary.c_str());
      print(entry.make()->settings(), out);
      found = true;
    }
  return found;
}

bool describe_experiment(const std::string& name, std::FILE* out) {
  for (const EmbeddedText& stored : embedded_experiments()) {
    if (name != stored.name) continue;
    const Experiment experiment = Experiment::load(name);
    std::fprintf(out, "%s: an experiment: %s\n%s\n", stored.name, experiment.settings().title.c_str(),
                 parse_json(experiment.to_json(), name).dump(2).c_str());
    std::fputs("Parameters of the run itself; those of its sections: remote-touch describe SECTION\n", out);
    describe_section("run", out);
    return true;
  }
  return false;
}

bool describe_sweep(const std::string& name, std::FILE* out) {
  for (const EmbeddedText& stored : embedded_sweeps()) {
    if (name != stored.name) continue;
    const Sweep sweep = Sweep::load(name);
    const SweepGrid outline = sweep.outline();
    const std::size_t runs =
        sweep.keep() == Keep::runs ? sweep.plan().runs_in(RunState::pending).size() : outline.run_count();
    std::fprintf(out, "%s: a sweep: %s\n%s\n", stored.name, sweep.title().c_str(),
                 parse_json(sweep.to_json(), name).dump(2).c_str());
    std::fprintf(out, "Axes: %zu cells; %zu runs in the first round\n", outline.cell_count(), runs);
    for (const Column& axis : outline.axes)
      std::fprintf(out, "  %-24s %zu values of %s\n", axis.name.c_str(), axis.length(),
                   axis.long_name.c_str());
    return true;
  }
  return false;
}

bool describe_method(const std::string& name, std::FILE* out) {
  for (const Method& method : chosen_methods({})) {
    if (name != method.name) continue;
    std::fprintf(out, "%s: a method of the scorecard: %s\n%s\n", name.c_str(), method.title.c_str(),
                 parse_json(method.renderer, name).dump(2).c_str());
    return true;
  }
  return false;
}

bool describe_scene(const std::string& name, std::FILE* out) {
  for (const BenchmarkScene& scene : chosen_scenes({})) {
    if (name != scene.name) continue;
    std::fprintf(out, "%s: a scene of the scorecard: %s\n%s\n", name.c_str(), scene.title.c_str(),
                 parse_json(scene.experiment, name).dump(2).c_str());
    std::fprintf(out, "Noise: %s\nSuccess: %s\n", scene.noise.empty() ? "its own" : scene.noise.c_str(),
                 scene.meaning.c_str());
    for (const Bound& bound : scene.success)
      std::fprintf(out, "Bound: %s within %g .. %g\n", bound.measure.c_str(), bound.min, bound.max);
    return true;
  }
  return false;
}

// Prints what the renderers make of a built-in tool or a mesh file in metres by default. Returns false if the
// name is neither.
bool describe_tool(const std::string& name, std::FILE* out) {
  const GeneratedTool* built_in = find_generated_tool(name);
  if (built_in == nullptr && !is_mesh_file(name)) return false;
  LoadedSpheres::Settings settings;
  settings.tool.mesh = name;
  std::string report;
  load_tool_of_spheres(settings.tool, settings.leaves, &report);
  std::fprintf(out, "%s: a tool: %s\n%s\n", name.c_str(), built_in ? built_in->summary : "from a mesh file",
               report.c_str());
  return true;
}

void print(const TraceColumn& column, std::FILE* out) {
  std::fprintf(out, "  %-24s %-4s x %d  %s\n", column.name, column.unit, column.width,
               meaning_of(column).c_str());
  if (std::string_view(column.meaning) != column.meaning_with_tool)
    std::fprintf(out, "  %-24s            with a tool: %s\n", "", column.meaning_with_tool);
}

// Prints the columns that a run stores, in the order of the file.
bool describe_trace(const std::string& name, std::FILE* out) {
  if (name != "trace") return false;
  std::fputs(
      "trace: what a run records, one row for each tick. For each column: unit, numbers per row, meaning:\n",
      out);
  std::optional<TracePart> part;
  for (const TraceColumn& column : trace_columns()) {
    if (part != column.part) std::fprintf(out, "In %s:\n", runs_with(column.part));
    part = column.part;
    print(column, out);
  }
  return true;
}

// Tests read the time and --quick from this line, so that they keep no list of slow figures of their own.
bool describe_figure(const std::string& name, std::FILE* out) {
  const auto is_it = [&](const FigureEntry& entry) { return name == entry.name; };
  const auto entry = std::find_if(figures().begin(), figures().end(), is_it);
  if (entry == figures().end()) return false;
  std::fprintf(out, "%s: a figure: %s; about %g s on one fast core", entry->name, entry->summary,
               entry->expected_s);
  if (entry->quick_coarse > 1)
    std::fprintf(out, "; --quick uses one in %d values of each axis of its map", entry->quick_coarse);
  return std::fputs("\n", out) >= 0;
}

}  // namespace

void describe(const std::string& name, std::FILE* out) {
  bool found = describe_section(name, out);
  found |= describe_entry(name, out);
  found |= describe_experiment(name, out);
  found |= describe_sweep(name, out);
  found |= describe_method(name, out);
  found |= describe_scene(name, out);
  found |= describe_trace(name, out);
  found |= describe_tool(name, out);
  found |= describe_figure(name, out);
  for (const Measure& measure : measures())
    if (name == measure.name)
      found = std::fprintf(out, "%s: a measure: %s\n", name.c_str(), summary_of(measure).c_str()) > 0;
  if (found || describe_parameter(name, out)) return;
  throw InputError(
      name, "unknown: expected a name from `remote-touch list`, or NAME.PARAMETER, such as proxy.r1_m");
}

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
