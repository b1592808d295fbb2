#include "runners/interfaces/descriptions/descriptions.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "analysis/trace/trace.h"
#include "core/dissertation/tool/shape/generated_tools.h"
#include "runners/evaluation/figures/figures.h"
#include "runners/evaluation/scorecard/benchmark.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/catalog/sections.h"
#include "runners/experiment/mesh_files/mesh_file.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/settings/stored_configuration.h"
#include "runners/experiment/tool_files/loaded_tool.h"
#include "runners/interfaces/descriptions/parameter_description.h"
#include "runners/sweep/sweep.h"

namespace remote_touch {

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
    const SweepResult outline = sweep.outline();
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
  for (const char* section : {"scenario", "trajectory"})
    if (const auto renamed = renamed_entry(section, name))
      throw InputError(name, "unknown; it is now " + *renamed);
  throw InputError(
      name, "unknown: expected a name from `remote-touch list`, or NAME.PARAMETER, such as proxy.r1_m");
}

}  // namespace remote_touch
