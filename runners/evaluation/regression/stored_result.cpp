#include "runners/evaluation/regression/stored_result.h"

#include <algorithm>

#include "core/parameters/input_error.h"
#include "runners/evaluation/regression/result_comparison.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/stored_configuration.h"
#include "runners/sweep/sweep_answer.h"

namespace remote_touch {

namespace {

std::string configuration_of_replay(const Sweep& sweep, const Recipe& replay) {
  const SweepResult outline = sweep.outline();
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
  return stored_configuration(of("config"));
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
