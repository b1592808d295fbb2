#include <cstdio>
#include <nlohmann/json.hpp>

#include "analysis/measures/measures.h"
#include "core/tool/mesh/generated_tools.h"
#include "runners/cli/commands.h"
#include "runners/experiment/catalog.h"
#include "runners/experiment/experiment.h"
#include "runners/figures/figures.h"
#include "runners/scorecard/benchmark.h"
#include "runners/settings/json_parameters.h"
#include "runners/sweep/sweep.h"
#include "runners/tool_files/loaded_spheres.h"
#include "runners/tool_files/mesh_file.h"

namespace remote_touch {

namespace {

void print(const Parameters& parameters) {
  for (const Parameter& p : parameters)
    std::printf("  %-24s %s\n  %-24s default %s; allowed %s\n", p.name.c_str(), p.help.c_str(), "",
                value_text(p).c_str(), allowed(p).c_str());
}

// Prints a part of experiments that is no entry of the catalog, if it has that name.
template <class Settings>
bool describe_section(const char* section, const char* what, const std::string& name) {
  if (name != section) return false;
  std::printf("%s: %s\n", section, what);
  Settings settings;
  print(parameters(settings));
  return true;
}

// Prints the entry of that name, if the table has it.
template <class Entry>
bool describe_entry(std::span<const Entry> entries, const char* kind, const std::string& name) {
  for (const Entry& entry : entries) {
    if (name != entry.name) continue;
    std::printf("%s: a %s: %s\n", entry.name, kind, entry.summary);
    print(entry.make()->settings());
    return true;
  }
  return false;
}

void print_run_settings() {
  RunSettings settings;
  print(parameters(settings));
}

bool describe_experiment(const std::string& name) {
  for (const EmbeddedText& stored : embedded_experiments()) {
    if (name != stored.name) continue;
    const Experiment experiment = Experiment::load(name);
    std::printf("%s: an experiment: %s\n%s\n", stored.name, experiment.settings().title.c_str(),
                parse_json(experiment.to_json(), name).dump(2).c_str());
    std::puts("Parameters of the run itself; those of its parts: remote-touch describe PART");
    print_run_settings();
    return true;
  }
  return false;
}

bool describe_sweep(const std::string& name) {
  for (const EmbeddedText& stored : embedded_sweeps()) {
    if (name != stored.name) continue;
    const Sweep sweep = Sweep::load(name);
    const SweepResult plan = sweep.plan();
    std::printf("%s: a sweep: %s\n%s\n", stored.name, sweep.title().c_str(),
                parse_json(sweep.to_json(), name).dump(2).c_str());
    std::printf("Axes: %zu cells; %zu runs in the first round\n", plan.cell_count(),
                plan.runs_in(RunState::pending).size());
    for (const Column& axis : plan.axes)
      std::printf("  %-24s %zu values of %s\n", axis.name.c_str(), axis.length(), axis.long_name.c_str());
    return true;
  }
  return false;
}

bool describe_method(const std::string& name) {
  for (const Method& method : chosen_methods({})) {
    if (name != method.name) continue;
    std::printf("%s: a method of the scorecard: %s\n%s\n", name.c_str(), method.title.c_str(),
                parse_json(method.renderer, name).dump(2).c_str());
    return true;
  }
  return false;
}

bool describe_scene(const std::string& name) {
  for (const BenchmarkScene& scene : chosen_scenes({})) {
    if (name != scene.name) continue;
    std::printf("%s: a scene of the scorecard: %s\n%s\n", name.c_str(), scene.title.c_str(),
                parse_json(scene.experiment, name).dump(2).c_str());
    std::printf("Noise: %s\nSuccess: %s\n", scene.noise.empty() ? "its own" : scene.noise.c_str(),
                scene.meaning.c_str());
    for (const Bound& bound : scene.success)
      std::printf("Bound: %s within %g .. %g\n", bound.measure.c_str(), bound.min, bound.max);
    return true;
  }
  return false;
}

// A built-in tool or a mesh file in metres: what was made of it, as the renderers do by default.
bool describe_tool(const std::string& name) {
  const GeneratedTool* built_in = find_generated_tool(name);
  if (built_in == nullptr && !is_mesh_file(name)) return false;
  LoadedSpheres::Settings settings;
  settings.tool.mesh = name;
  std::string report;
  load_tool_of_spheres(settings.tool, settings.leaves, &report);
  std::printf("%s: a tool: %s\n%s\n", name.c_str(), built_in ? built_in->summary : "from a mesh file",
              report.c_str());
  return true;
}

}  // namespace

int command_describe(const CommandLine&, const DescribeRequest& request) {
  const std::string& name = request.name;
  bool found = describe_entry(scenarios(), "scenario", name);
  found |= describe_entry(fixtures(), "fixture rule", name);
  found |= describe_entry(renderers(), "renderer", name);
  found |= describe_entry(trajectories(), "trajectory", name);
  found |= describe_experiment(name);
  found |= describe_sweep(name);
  found |= describe_method(name);
  found |= describe_scene(name);
  if (name == "run") {
    std::puts("run: parameters of the run itself");
    print_run_settings();
    found = true;
  }
  found |= describe_section<SensorFaults>(
      "faults", "\"faults\" of an experiment: sensor faults, for any scenario", name);
  found |= describe_section<DepthPipelineSettings>(
      "depth-pipeline",
      "\"depth_pipeline\" of an experiment: depth images are filtered and get normals, 6.2.1", name);
  found |= describe_section<GuidanceSettings>(
      "guidance", "\"guidance\" of an experiment: the springs of fixtures with role = guidance, 7.3.2", name);
  found |= describe_section<SequenceStep>(
      "sequence", "\"sequence\" of an experiment: steps that enable and disable fixtures", name);
  found |= describe_section<OperatorSettings>(
      "operator",
      "\"operator\" of an experiment: a simulated hand that follows the trajectory and feels forces", name);
  found |= describe_section<MotorSettings>(
      "device", "\"device\" of an experiment: actuated axes of the haptic device", name);
  found |= describe_section<LiveSettings>(
      "live", "\"live\" of an experiment: where device and camera stand when it is run in real time", name);
  found |= describe_section<SafetyLimits>(
      "safety", "\"safety\" of an experiment: limits of the force on a real haptic device", name);
  found |= describe_tool(name);
  for (const FigureEntry& entry : figures())
    if (name == entry.name) found = std::printf("%s: a figure: %s\n", entry.name, entry.summary) > 0;
  for (const Measure& measure : measures())
    if (name == measure.name)
      found = std::printf("%s: a measure: %s, %s\n", measure.name, measure.meaning, measure.unit) > 0;
  if (!found) throw InputError(name, "unknown: expected a name from `remote-touch list`");
  return kDone;
}

}  // namespace remote_touch
