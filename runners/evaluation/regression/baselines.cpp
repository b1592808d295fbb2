#include "runners/evaluation/regression/baselines.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/digest.h"
#include "analysis/storage/other_processes.h"
#include "analysis/storage/result_file.h"
#include "analysis/storage/trace_comparison.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/trace/columns.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep.h"
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
    return Experiment::from_json(text, "config").to_json();
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
    return Sweep::from_json(text, "config").to_json();
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
  } catch (const MissingInput& error) {
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

namespace {

// Throws InputError if the text is not UTF-8, because JSON holds no other text.
void require_utf8(const std::string& option, const std::string& text) {
  try {
    static_cast<void>(Json(text).dump());
  } catch (const Json::exception&) {
    throw InputError(option, "expected UTF-8 text");
  }
}

void require_sense(const Blessing& blessing) {
  const bool blank = std::all_of(blessing.reason.begin(), blessing.reason.end(),
                                 [](unsigned char c) { return std::isspace(c) != 0; });
  if (blank)
    throw InputError("--reason",
                     "missing: expected a sentence that explains why the new numbers are correct");
  if (blessing.also.empty() && !blessing.one_compiler)
    throw InputError(
        "--other-build",
        "missing: expected a build of the same source by another compiler (scripts/bless makes one), "
        "or --one-compiler");
  if (!blessing.run.empty() && !blessing.sweep.empty())
    throw InputError("--run, --sweep", "both are given: expected one of them");
  require_utf8("--reason", blessing.reason);
  require_utf8("--run", blessing.run);
  require_utf8("--sweep", blessing.sweep);
  if (blessing.name.empty())
    throw InputError("baseline", "without a name: expected letters, digits, . - and _");
  for (const char c : blessing.name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-' && c != '_')
      throw InputError("baseline " + blessing.name, "expected letters, digits, . - and _");
}

Manifest manifest_or_new(const std::filesystem::path& folder) {
  std::error_code unreachable;
  return std::filesystem::exists(manifest_file(folder), unreachable) ? read_manifest(folder) : Manifest{};
}

// These two throw InputError, before anything is run, if the manifest cannot be written, or if the experiment
// or sweep cannot be loaded.
void require_places(const std::filesystem::path& folder) {
  std::error_code unreachable;
  if (std::filesystem::exists(folder, unreachable)) require_writable(manifest_file(folder));
}
void require_runnable(const std::filesystem::path& folder, const Baseline& baseline) {
  if (baseline.command == "sweep")
    Sweep::load(subject_of(folder, baseline), baseline.overrides);
  else
    Experiment::load(subject_of(folder, baseline), baseline.overrides);
}

// Returns what to run: the stored experiment or sweep, or the one that is requested now. Throws InputError if
// there is neither.
Baseline definition(const Blessing& blessing, const Manifest& manifest) {
  const Baseline* stored = manifest.find(blessing.name);
  const bool is_new = !blessing.run.empty() || !blessing.sweep.empty();
  if (!stored && !is_new)
    throw InputError("baseline " + blessing.name,
                     "does not exist: expected --run EXPERIMENT or --sweep SWEEP to create it");
  if (!is_new && !blessing.overrides.empty())
    throw InputError("--set", "is given without --run or --sweep: expected one of them too");
  Baseline baseline = stored ? *stored : Baseline{blessing.name, "", ""};
  if (is_new) {
    baseline.command = blessing.run.empty() ? "sweep" : "run";
    baseline.subject = blessing.run.empty() ? blessing.sweep : blessing.run;
    baseline.overrides = blessing.overrides;
  }
  return baseline;
}

bool same_values(const std::vector<Column>& a, const std::vector<Column>& b) {
  const auto equal = [](const Column& x, const Column& y) {
    return compare_columns(x, y, {}).is_same() && x.name == y.name;
  };
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), equal);
}

void store(const std::filesystem::path& file, const std::string& command, const std::filesystem::path& made,
           std::vector<Column> columns) {
  if (command == "sweep") {
    StoredSweep sweep = read_sweep(made);
    sweep.result.measures = std::move(columns);
    write_sweep(file, sweep.result, sweep.attributes);
  } else {
    const StoredTrace trace(made);
    columns.push_back(trace.column(kRunningHash));
    columns.back().values = running_hash({columns.begin(), columns.end() - 1});
    write_trace(file, columns, provenance_of(trace.attributes()), {});
  }
}

std::string attribute_of(const std::filesystem::path& file, const char* name) {
  return attribute(Hdf5Reader(file).attributes(), name);
}

// Returns the stored columns. Returns none if there is no stored file, if it is damaged, or if it is of
// another experiment.
std::vector<Column> old_columns(const std::filesystem::path& file, const Baseline& baseline,
                                const std::filesystem::path& made) {
  std::error_code unreachable;
  if (!std::filesystem::exists(file, unreachable)) return {};
  try {
    if (!configuration_differences(attribute_of(file, "config"), attribute_of(made, "config")).empty())
      return {};
    return judged_columns(file, baseline.command);
  } catch (const InputError&) {
    return {};  // damaged: there are no old bits to keep
  }
}

bool same_definition(const Baseline& a, const Baseline& b) {
  return a.command == b.command && a.subject == b.subject && a.overrides == b.overrides;
}

std::string content_of(const std::filesystem::path& file) {
  std::string content(std::filesystem::file_size(file), '\0');
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "rb"), std::fclose);
  if (!in || std::fread(content.data(), 1, content.size(), in.get()) != content.size())
    throw InputError(file.string(), std::string("cannot be read (") + std::strerror(errno) +
                                        "): expected what was written a moment ago");
  return content;
}

// Writes a new result and the manifest together, so that a result is never without its entry in the manifest.
void keep(const std::filesystem::path& folder, const Manifest& manifest, const std::filesystem::path& file,
          const std::optional<std::string>& content) {
  make_folder(folder);
  const std::string list = text_of(manifest);
  NewFiles files(std::to_string((content ? content->size() : 0) + list.size()) + " bytes");
  if (content) files.begin(file), files.append(*content);
  files.begin(manifest_file(folder)), files.append(list);
  files.finish();
}

void enter(const Baseline& baseline, Manifest& manifest) {
  const auto place = std::find_if(manifest.baselines.begin(), manifest.baselines.end(),
                                  [&](const Baseline& one) { return one.name == baseline.name; });
  if (place != manifest.baselines.end())
    *place = baseline;
  else
    manifest.baselines.push_back(baseline);
  std::sort(manifest.baselines.begin(), manifest.baselines.end(),
            [](const Baseline& a, const Baseline& b) { return a.name < b.name; });
}

// Returns the changed columns or measures as text: "force: 12 of 867 rows, up to 0.4 N; normal: ...".
std::string moved(const std::vector<Column>& before, const std::vector<Column>& now) {
  std::string text;
  const auto add = [&](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
  const auto named = [](const std::vector<Column>& columns, const std::string& name) {
    return std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
  };
  for (const Column& column : now) {
    const auto old = named(before, column.name);
    if (old == before.end()) {
      add(column.name + ": new");
      continue;
    }
    const ColumnComparison c = compare_columns(*old, column, {});
    if (c.is_same()) continue;
    add(column.name + ": " +
        (c.problem.empty()
             ? formatted("%zu of %zu rows, up to %.3g %s", c.outside, c.rows, c.max, c.units.c_str())
             : c.problem));
  }
  for (const Column& column : before)
    if (named(now, column.name) == now.end()) add(column.name + ": gone");
  return text;
}

std::string spread_text(const Tolerances& spread) {
  if (spread.empty()) return "exact";
  std::string text = "spread";
  for (const auto& [name, tolerance] : spread)
    text += formatted(" %s %.3g", name.c_str(), tolerance.absolute);
  return text;
}

MeasuredSpread measured_over_builds(const Blessing& blessing, const Baseline& baseline,
                                    const std::filesystem::path& scratch) {
  std::vector<std::string> programs = {this_program()};
  programs.insert(programs.end(), blessing.also.begin(), blessing.also.end());
  MeasuredSpread measured = measure_spread(blessing.folder, baseline, programs, scratch, blessing.stop);
  if (measured.compilers.size() < 2 && !blessing.one_compiler)
    throw InputError("--other-build", "by the same compiler, " + *measured.compilers.begin() +
                                          ": expected a build by another compiler, or --one-compiler");
  return measured;
}

}  // namespace

std::string bless(const Blessing& blessing) {
  require_sense(blessing);
  const FolderLock alone(blessing.folder);
  Manifest manifest = manifest_or_new(blessing.folder);
  Baseline baseline = definition(blessing, manifest);
  require_places(blessing.folder);
  require_runnable(blessing.folder, baseline);
  const std::filesystem::path file = file_of(blessing.folder, baseline);
  for (const auto& target : {file, manifest_file(blessing.folder)}) remove_leftovers(target);
  const ScratchFolder scratch;
  const MeasuredSpread measured = measured_over_builds(blessing, baseline, scratch.path());
  const std::vector<Column> old = old_columns(file, baseline, measured.reference);
  std::vector<Column> now = judged_columns(measured.reference, baseline.command);
  if (!old.empty()) now = keep_old_bits(old, std::move(now), baseline.tolerances);
  const bool is_new = old.empty() || !same_values(old, now);
  const Baseline* stored = manifest.find(blessing.name);
  if (!is_new && stored && same_definition(*stored, baseline) && measured.spread == baseline.tolerances &&
      sha256_of_file(file) == baseline.sha256)
    return baseline.name + ": nothing to store, every number is within the spread of the stored one";
  const std::string what_moved = is_new && !old.empty() ? moved(old, now) : "";
  const std::filesystem::path made = is_new ? scratch.path() / "stored.h5" : file;
  if (is_new) store(made, baseline.command, measured.reference, std::move(now));
  const std::string sha256 = sha256_of_file(made);
  // A stored result keeps its reason if its file was damaged and is replaced by the same bits.
  if (!stored || sha256 != stored->sha256 || !same_definition(*stored, baseline)) {
    if (stored) baseline.history.push_back(stored->revision);
    baseline.revision = {blessing.reason, what_moved};
  }
  baseline.sha256 = sha256, baseline.builds = measured.over, baseline.tolerances = measured.spread;
  enter(baseline, manifest);
  keep(blessing.folder, manifest, file, is_new ? std::make_optional(content_of(made)) : std::nullopt);
  return baseline.name + ": " + (is_new ? "stored" : "the manifest is new, the numbers are kept") + ", " +
         spread_text(baseline.tolerances) + (what_moved.empty() ? "" : "; moved: " + what_moved);
}

}  // namespace remote_touch
