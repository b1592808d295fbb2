#include "runners/evaluation/regression/baselines.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/parameters/parameter.h"
#include "runners/evaluation/regression/result_comparison.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/sweep/sweep_answer.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

Revision revision_of(const Json& json) {
  return {json.at("reason"), json.value("moved", "")};
}

Json json_of(const Revision& revision) {
  return {{"reason", revision.reason}, {"moved", revision.moved}};
}

Baseline baseline_of(const Json& json, const std::filesystem::path& file) {
  Baseline baseline{json.at("name"), json.at("command"), json.at("subject")};
  if (baseline.command != "run" && baseline.command != "sweep")
    throw InputError(file.string(), "baseline " + baseline.name + ": command: expected run, sweep");
  baseline.overrides = json.at("set").get<std::vector<std::string>>();
  baseline.sha256 = json.at("sha256"), baseline.revision = revision_of(json);
  if (const auto found = json.find("history"); found != json.end())
    for (const Json& one : found->get_ref<const Json::array_t&>())
      baseline.history.push_back(revision_of(one));
  baseline.builds = json.at("measured_over").get<std::vector<std::string>>();
  for (const auto& [name, spread] : json.at("spread").get_ref<const Json::object_t&>()) {
    if (!(spread.get<double>() >= 0))
      throw InputError(file.string(),
                       "baseline " + baseline.name + ": spread of " + name + ": expected 0 or more");
    baseline.tolerances[name].absolute = spread;
  }
  return baseline;
}

Json json_of(const Baseline& baseline) {
  Json spread = Json::object();
  for (const auto& [name, tolerance] : baseline.tolerances) spread[name] = tolerance.absolute;
  Json history = Json::array();
  for (const Revision& revision : baseline.history) history.push_back(json_of(revision));
  return {{"name", baseline.name},
          {"command", baseline.command},
          {"subject", baseline.subject},
          {"set", baseline.overrides},
          {"sha256", baseline.sha256},
          {"reason", baseline.revision.reason},
          {"moved", baseline.revision.moved},
          {"history", history},
          {"spread", spread},
          {"measured_over", baseline.builds}};
}

}  // namespace

const Baseline* Manifest::find(const std::string& name) const {
  const auto found = std::find_if(baselines.begin(), baselines.end(),
                                  [&](const Baseline& baseline) { return baseline.name == name; });
  return found == baselines.end() ? nullptr : &*found;
}

std::filesystem::path manifest_file(const std::filesystem::path& folder) {
  return folder / "manifest.json";
}

Manifest read_manifest(const std::filesystem::path& folder) {
  const std::filesystem::path file = manifest_file(folder);
  const Json json = parse_json(
      read_text_file(file,
                     "expected a folder of baselines (--folder), or the project's root as working folder"),
      file.string());
  try {
    Manifest manifest{json.at("complete")};
    for (const Json& one : json.at("baselines")) manifest.baselines.push_back(baseline_of(one, file));
    return manifest;
  } catch (const Json::exception& error) {
    std::string what = error.what();  // "[json.exception...] key 'spread' not found"
    if (const auto end = what.find("] "); end != std::string::npos) what.erase(0, end + 2);
    throw InputError(file.string(), what + ": expected what remote-touch baseline bless writes");
  }
}

std::string text_of(const Manifest& manifest) {
  Json list = Json::array();
  for (const Baseline& baseline : manifest.baselines) list.push_back(json_of(baseline));
  return Json({{"complete", manifest.complete}, {"baselines", list}}).dump(2) + "\n";
}

std::filesystem::path file_of(const std::filesystem::path& folder, const Baseline& baseline) {
  return folder / (baseline.name + ".h5");
}

std::string subject_of(const std::filesystem::path& folder, const Baseline& baseline) {
  return baseline.subject.ends_with(".json") ? (folder / baseline.subject).string() : baseline.subject;
}

namespace {

std::string configuration_of_replay(const Sweep& sweep, const Recipe& replay) {
  const SweepGrid outline = sweep.outline();
  const std::vector<std::size_t>& place = replay.cell;
  if (place.size() != outline.axes.size() || replay.replicate < 0 || replay.replicate >= outline.replicates)
    return {};
  for (std::size_t i = 0; i < place.size(); ++i)
    if (place[i] >= outline.axes[i].length()) return {};
  return sweep.experiment(outline.cell_at(place), replay.replicate).to_json();
}

// Returns the configuration that the recipe would produce now. Empty for a result that has no configuration
// of its own.
std::string configuration_of(const Recipe& recipe) {
  if (recipe.action == "run") return Experiment::load(recipe.subject, recipe.overrides).to_json();
  if (recipe.action != "sweep" && recipe.action != "replay") return {};
  const Sweep sweep = Sweep::load(recipe.subject, recipe.overrides);
  return recipe.action == "sweep" ? sweep.to_json() : configuration_of_replay(sweep, recipe);
}

bool is_of_scorecard(const std::string& command) {
  return command.find(" scorecard ") != std::string::npos || command.ends_with(" scorecard");
}

}  // namespace

StoredResult::StoredResult(const Hdf5Reader& result)
    : file_(result.file()),
      kind_(kind_of(result)),
      attributes_(result.attributes()),
      recipe_(recipe_of(attributes_)) {}

std::string StoredResult::config() const {
  return of("config");
}

Experiment StoredResult::experiment() const {
  return read_configuration(attributes_, file_,
                            [&] { return Experiment::from_json(config(), file_ + " config"); });
}

Sweep StoredResult::sweep() const {
  return read_configuration(attributes_, file_,
                            [&] { return Sweep::from_json(config(), file_ + " config"); });
}

Remaking StoredResult::remaking() const {
  const std::string maker = other_maker(attributes_);
  if (!maker.empty() && !is_known()) return {{}, maker};
  if (kind_ == "figure") return figure_remaking();
  if (command_makes_it()) return {recipe_commands()};
  return detour();
}

// True if this program's catalog has every entry that the configuration names.
bool StoredResult::is_known() const {
  try {
    if (kind_ == "sweep") sweep();
    if (kind_ == "trace" || kind_ == "hashes") experiment();
    return true;
  } catch (const InputError&) {
    return false;
  }
}

bool StoredResult::command_makes_it() const {
  try {
    const std::string now = recipe_ ? configuration_of(*recipe_) : std::string();
    return !now.empty() && configuration_differences(config(), now).empty();
  } catch (const InputError&) {
    return false;
  }
}

// A replay needs two commands: that of its sweep, and then its own.
std::vector<std::string> StoredResult::recipe_commands() const {
  auto all = commands(*recipe_);
  all[0].insert(all[0].end(), {"-o", all.size() > 1 ? "map.h5" : "again.h5"});
  add_shard(all[0]);
  if (all.size() < 2) return {shell_command(all[0])};
  all[1].insert(std::find(all[1].begin(), all[1].end(), "replay") + 1, "map.h5");
  all[1].insert(all[1].end(), {"-o", "again.h5"});
  return {shell_command(all[0]), shell_command(all[1])};
}

Remaking StoredResult::figure_remaking() const {
  if (of("figure") == kAnswerName) return {{of("command") + " -o again.h5"}};
  if (!recipe_ || (recipe_->action != "figure" && recipe_->action != "compare")) {
    if (is_of_scorecard(of("command"))) return {{}, "made by " + of("command") + " -o FOLDER"};
    return {{}, "not made by a command of this program"};
  }
  const bool is_plot = recipe_->action == "compare";
  std::vector<std::string> words = commands(*recipe_).front();
  words.insert(words.end(), {is_plot ? "--plot" : "-o", is_plot ? "again.h5" : "again"});
  return {{shell_command(words)}};
}

Remaking StoredResult::detour() const {
  Remaking made;
  if (is_of_scorecard(of("command")))
    made.reason = "it belongs to a scorecard, made by " + of("command") + " -o FOLDER; to make it alone:";
  else
    made.reason =
        "its command no longer makes this configuration (another file, another default, or a name that has "
        "changed)";
  std::vector<std::string> words = program_words(), config = words;
  words.insert(words.end(), {kind_ == "sweep" ? "sweep" : "run", "again.json", "-o", "again.h5"});
  config.insert(config.end(), {"repro", file_, "--config", "again.json"});
  add_shard(words);
  made.commands = {shell_command(config), shell_command(words)};
  return made;
}

void StoredResult::add_shard(std::vector<std::string>& words) const {
  if (!of("shard").empty()) words.insert(words.end(), {"--shard", of("shard")});
}

}  // namespace remote_touch
