#include "runners/evaluation/regression/baseline_check.h"

#include <nlohmann/json.hpp>
#include <set>

#include "analysis/storage/digest.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/trace/trace.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/input_hashes.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/settings/stored_configuration.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep_run.h"
#include "scenarios/recordings/recorded_scene.h"

namespace remote_touch {

namespace {

using State = BaselineCheck::State;

// Returns the stored configuration as this program writes it: parameters that were added since then have
// their defaults. A configuration that cannot be read any more is returned unchanged.
template <class Read>
std::string present_form(const std::string& stored, Read&& read) {
  try {
    return read(stored);
  } catch (const InputError&) {
    return stored;
  }
}

TextAttributes with_config(TextAttributes attributes, const std::string& config) {
  for (auto& [name, value] : attributes)
    if (name == "config") value = config;
  return attributes;
}

ResultComparison compare_run(const std::filesystem::path& folder, const Baseline& baseline,
                             const Kernels& kernels, const std::atomic<bool>* stop, NoteCounts* notes) {
  const StoredTrace stored(file_of(folder, baseline));
  const Experiment experiment = Experiment::load(subject_of(folder, baseline), baseline.overrides);
  SimulationOptions options;
  options.kernels = &kernels, options.stop = stop, options.hash_frames = true;
  RunReport report;
  options.report = &report;
  const ColumnsInMemory made(simulate(experiment, options).columns());
  if (notes) notes->add(report.notes);
  const std::string config = present_form(attribute(stored.attributes(), "config"), [](const auto& text) {
    return Experiment::from_json(stored_configuration(text), "config").to_json();
  });
  return compare_trace(stored, with_config(stored.attributes(), config), made,
                       provenance(experiment.to_json(), attribute(stored.attributes(), "command"),
                                  kernels.isa, input_hashes(experiment.inputs())),
                       {baseline.tolerances});
}

ResultComparison compare_sweep_again(const std::filesystem::path& folder, const Baseline& baseline,
                                     const Kernels& kernels, const std::atomic<bool>* stop,
                                     NoteCounts* notes) {
  const StoredSweep stored = read_stored_sweep(file_of(folder, baseline));
  const Sweep sweep = Sweep::load(subject_of(folder, baseline), baseline.overrides);
  const SweepResult made = run_sweep(sweep, {&kernels, stop});
  if (notes) notes->add(made);
  const std::string config = present_form(attribute(stored.attributes, "config"), [](const auto& text) {
    return Sweep::from_json(stored_configuration(text), "config").to_json();
  });
  return compare_sweep(
      stored.result, with_config(stored.attributes, config), made,
      provenance(sweep.to_json(), attribute(stored.attributes, "command"), "", input_hashes(sweep.inputs())),
      {baseline.tolerances});
}

BaselineCheck concluded(const Baseline& baseline, ResultComparison comparison) {
  BaselineCheck check{baseline.name};
  comparison.baseline = baseline.name + " (stored)", comparison.candidate = "this program";
  check.text = comparison.verdict;
  check.state = comparison.outcome == Outcome::same             ? State::same
                : comparison.outcome == Outcome::not_comparable ? State::not_comparable
                                                                : State::changed;
  if (check.state == State::same && !comparison.configuration.empty()) {
    check.state = State::changed;
    check.text = "the numbers are equal, but the experiment differs: " + comparison.configuration.front();
    comparison.outcome = Outcome::changed, comparison.verdict = check.text;
  }
  check.comparison = std::move(comparison);
  return check;
}

// Adds the names of the parts that a baseline runs: "experiment fig4.12", "renderer proxy", ...
void note_parts(const std::filesystem::path& folder, const Baseline& baseline, std::set<std::string>& parts) {
  if (baseline.command != "run") return;
  parts.insert("experiment " + baseline.subject);
  try {
    const Json config = parse_json(
        Experiment::load(subject_of(folder, baseline), baseline.overrides).to_json(), baseline.name);
    for (const char* part : {"scenario", "renderer", "trajectory"})
      parts.insert(std::string(part) + " " + config[part]["name"].get<std::string>());
    for (const Json& rule : config["fixtures"])
      parts.insert("fixture rule " + rule["name"].get<std::string>());
  } catch (const InputError&) {  // check_baseline() reports this error
  }
}

}  // namespace

BaselineCheck check_baseline(const std::filesystem::path& folder, const Baseline& baseline,
                             const Kernels& kernels, const std::atomic<bool>* stop, NoteCounts* notes) {
  try {
    const std::filesystem::path file = file_of(folder, baseline);
    if (sha256_of_file(file) != baseline.sha256)
      throw InputError(file.string(), "was modified: its SHA-256 differs from the manifest");
    return concluded(baseline, baseline.command == "sweep"
                                   ? compare_sweep_again(folder, baseline, kernels, stop, notes)
                                   : compare_run(folder, baseline, kernels, stop, notes));
  } catch (const MissingRecording& error) {
    return {baseline.name, State::not_run, error.what()};
  } catch (const InputError& error) {
    return {baseline.name, State::not_comparable, error.what()};
  }
}

std::vector<BaselineCheck> missing_baselines(const std::filesystem::path& folder, const Manifest& manifest) {
  if (!manifest.complete) return {};
  std::set<std::string> parts;
  for (const Baseline& baseline : manifest.baselines) note_parts(folder, baseline, parts);
  std::vector<BaselineCheck> missing;
  const auto require = [&](const std::string& part) {
    // The parts named live-session need a recording of a live session. Their own tests make one and replay
    // it.
    const bool is_tested_elsewhere = part.ends_with(" live-session");
    if (!parts.contains(part) && !is_tested_elsewhere)
      missing.push_back({part, State::missing, "has no baseline"});
  };
  for (const EmbeddedText& experiment : embedded_experiments())
    require(std::string("experiment ") + experiment.name);
  for (const auto& entry : scenarios()) require(std::string("scenario ") + entry.name);
  for (const auto& entry : fixtures())
    if (entry.make()->inputs().empty()) require(std::string("fixture rule ") + entry.name);
  for (const auto& entry : renderers()) require(std::string("renderer ") + entry.name);
  for (const auto& entry : trajectories()) require(std::string("trajectory ") + entry.name);
  return missing;
}

}  // namespace remote_touch
