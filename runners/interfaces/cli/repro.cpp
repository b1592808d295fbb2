#include <algorithm>
#include <cstdio>
#include <optional>

#include "analysis/comparison/column_source.h"
#include "analysis/comparison/tick_hashes.h"
#include "analysis/figures/result_file.h"
#include "analysis/scorecard/scorecard.h"
#include "analysis/storage/atomic_file.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/trace/hash64.h"
#include "core/parameters/input_error.h"
#include "runners/evaluation/regression/comparison_text.h"
#include "runners/experiment/provenance/input_hashes.h"
#include "runners/experiment/provenance/maker.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/provenance/shell_command.h"
#include "runners/experiment/settings/configuration_difference.h"
#include "runners/experiment/settings/stored_configuration.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/figure_runs.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/progress.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep_answer.h"
#include "runners/sweep/sweep_run.h"

namespace remote_touch {

namespace {

// Prints the text as comments of a shell script. Every line begins with '#', so a shell executes none.
void comment(const std::string& text) {
  std::string lines = "# ";
  for (const char c : text) lines += c == '\n' ? std::string("\n# ") : std::string(1, c);
  std::printf("%s\n", lines.c_str());
}

// A stored result, and the means to make it again with this program.
class Repro {
 public:
  Repro(const CommandLine& line, const std::string& file) : Repro(line, Hdf5Reader(file)) {}

  std::string of(const char* name) const { return attribute(attributes_, name); }
  std::string config() const { return stored_configuration(of("config")); }

  // Prints comments about the build, and then the commands to type.
  void print() const {
    comment(file_ + ": version " + of("version") + ", commit " + of("git_commit") +
            (of("git_dirty") == "yes" ? " with local changes, " : ", ") + of("compiler") + ", " +
            of("flags") + (of("isa").empty() ? "" : ", " + of("isa")));
    for (const auto& [name, value] : provenance("", "", line_.kernels->isa))
      if (name != "config" && name != "command" && !of(name.c_str()).empty() && of(name.c_str()) != value)
        comment("this program has another " + name + ": " + value);
    const std::string maker = other_maker(attributes_);
    if (!maker.empty()) comment("it " + maker);
    if (!of("input_digests").empty()) comment("it read:\n" + of("input_digests"));
    if (!maker.empty() && !is_known()) return;
    if (kind_ == "figure")
      print_figure_command();
    else if (command_makes_it())
      print_command();
    else
      print_detour();
  }

  void write_config(const std::string& target) const {
    if (kind_ == "figure")
      throw InputError("--config",
                       "a figure has no single configuration: expected a trace, a sweep or hashes");
    require_report(line_, target, {file_}, kConfiguration);
    const std::string text = config() + "\n";
    write_file_atomically(target, text.data(), text.size());
    std::printf("# configuration written to %s\n", target.c_str());
  }

  // Makes it again from its configuration and compares every number.
  ResultComparison again() const {
    Progress progress("repro", line_.quiet);
    ResultComparison result = kind_ == "trace"    ? trace_again(progress)
                              : kind_ == "hashes" ? hashes_again(progress)
                              : kind_ == "sweep"  ? sweep_again()
                                                  : figure_again(progress);
    result.baseline = file_, result.candidate = "this program";
    return result;
  }

 private:
  Repro(const CommandLine& line, const Hdf5Reader& result)
      : line_(line),
        file_(result.file()),
        kind_(kind_of(result)),
        attributes_(result.attributes()),
        recipe_(recipe_of(attributes_)) {
    if (kind_ == "figure" && of("figure") == kScorecardFigure)
      throw InputError(file_, "is a scorecard, which " + of("command") +
                                  " -o FOLDER makes again: expected a file of its runs/");
  }

  // True if this program's catalog has every entry that the configuration names.
  bool is_known() const {
    try {
      if (kind_ == "sweep") stored_sweep();
      if (kind_ == "trace" || kind_ == "hashes") stored_experiment();
      return true;
    } catch (const InputError&) {
      return false;
    }
  }
  Experiment stored_experiment() const {
    return read_configuration(attributes_, file_,
                              [&] { return Experiment::from_json(config(), file_ + " config"); });
  }
  Sweep stored_sweep() const {
    return read_configuration(attributes_, file_,
                              [&] { return Sweep::from_json(config(), file_ + " config"); });
  }

  // A replay needs two commands: that of its sweep, and then its own.
  void print_command() const {
    auto all = commands(*recipe_);
    all[0].insert(all[0].end(), {"-o", all.size() > 1 ? "map.h5" : "again.h5"});
    add_shard(all[0]);
    std::printf("%s\n", shell_command(all[0]).c_str());
    if (all.size() < 2) return;
    all[1].insert(std::find(all[1].begin(), all[1].end(), "replay") + 1, "map.h5");
    all[1].insert(all[1].end(), {"-o", "again.h5"});
    std::printf("%s\n", shell_command(all[1]).c_str());
  }

  void print_figure_command() const {
    if (of("figure") == kAnswerName) {
      std::printf("%s -o again.h5\n", of("command").c_str());
      return;
    }
    if (!recipe_ || (recipe_->action != "figure" && recipe_->action != "compare"))
      return comment("not made by a command of this program");
    const bool is_plot = recipe_->action == "compare";
    std::vector<std::string> words = commands(*recipe_).front();
    words.insert(words.end(), {is_plot ? "--plot" : "-o", is_plot ? "again.h5" : "again"});
    std::printf("%s\n", shell_command(words).c_str());
  }

  // Prints commands that make the result again from its configuration alone, and the reason for this detour.
  void print_detour() const {
    if (of("command").find(" scorecard ") != std::string::npos)
      comment("it belongs to a scorecard, made by " + of("command") + " -o FOLDER; to make it alone:");
    else
      comment(
          "its command no longer makes this configuration (another file, another default, or a name that has "
          "changed)");
    std::vector<std::string> words = program_words(), config = words;
    words.insert(words.end(), {kind_ == "sweep" ? "sweep" : "run", "again.json", "-o", "again.h5"});
    config.insert(config.end(), {"repro", file_, "--config", "again.json"});
    add_shard(words);
    std::printf("%s\n%s\n", shell_command(config).c_str(), shell_command(words).c_str());
  }
  void add_shard(std::vector<std::string>& words) const {
    if (!of("shard").empty()) words.insert(words.end(), {"--shard", of("shard")});
  }

  bool command_makes_it() const {
    try {
      const std::string now = recipe_ ? configuration_of(*recipe_) : std::string();
      return !now.empty() && configuration_differences(config(), now).empty();
    } catch (const InputError&) {
      return false;
    }
  }
  // Returns the configuration that the recipe would produce now. Empty for a result that has no configuration
  // of its own.
  static std::string configuration_of(const Recipe& recipe) {
    if (recipe.action == "run") return Experiment::load(recipe.subject, recipe.overrides).to_json();
    if (recipe.action != "sweep" && recipe.action != "replay") return {};
    const Sweep sweep = Sweep::load(recipe.subject, recipe.overrides);
    return recipe.action == "sweep" ? sweep.to_json() : configuration_of(sweep, recipe);
  }
  static std::string configuration_of(const Sweep& sweep, const Recipe& replay) {
    const SweepResult plan = sweep.plan();
    const std::vector<std::size_t>& place = replay.cell;
    if (place.size() != plan.axes.size() || replay.replicate < 0 || replay.replicate >= plan.replicates)
      return {};
    for (std::size_t i = 0; i < place.size(); ++i)
      if (place[i] >= plan.axes[i].length()) return {};
    return sweep.experiment(plan.cell_at(place), replay.replicate).to_json();
  }

  std::vector<Column> columns_again(const Experiment& experiment, Progress& progress) const {
    SimulationOptions options;
    options.kernels = line_.kernels, options.stop = line_.stop, options.hash_frames = true;
    options.progress = [&](double fraction) { progress.update(fraction); };
    return simulate(experiment, options).columns();
  }
  TextAttributes ours(const std::string& config, const std::string& inputs) const {
    return provenance(config, of("command"), of("isa").empty() ? "" : line_.kernels->isa, inputs);
  }

  ResultComparison trace_again(Progress& progress) const {
    const Experiment experiment = stored_experiment();
    const ColumnsInMemory made(columns_again(experiment, progress));
    const StoredTrace stored(file_);
    return compare_trace(stored, attributes_, made,
                         ours(experiment.to_json(), input_hashes(experiment.inputs())), {});
  }
  ResultComparison hashes_again(Progress& progress) const {
    const Experiment experiment = stored_experiment();
    const Column all = columns_again(experiment, progress).back();
    TickHashes made;
    for (const std::uint64_t hash : std::get<std::vector<std::uint64_t>>(all.values)) {
      made.tick.push_back(static_cast<std::int32_t>(made.tick.size()));
      made.hash.push_back(hash);
    }
    return compare_hashes(read_hashes(file_),
                          {made, ours(experiment.to_json(), input_hashes(experiment.inputs()))});
  }
  ResultComparison sweep_again() const {
    const StoredSweep stored = read_stored_sweep(file_);
    if (!of("shard").empty() || stored.in_progress)
      throw InputError(file_, "is a part of a sweep: expected a finished one, whole or merged");
    const Sweep sweep = stored_sweep();
    SweepRunOptions options;
    options.kernels = line_.kernels, options.stop = line_.stop;
    return compare_sweep(stored.result, stored.attributes, run_sweep(sweep, options),
                         ours(sweep.to_json(), input_hashes(sweep.inputs())), {});
  }
  ResultComparison figure_again(Progress& progress) const {
    const auto is_it = [&](const FigureEntry& entry) { return entry.name == of("figure"); };
    const auto entry = std::find_if(figures().begin(), figures().end(), is_it);
    if (entry == figures().end())
      throw InputError(file_, "is figure " + of("figure") + ", which this program does not know");
    const std::vector<FigureRun> runs = {{&*entry, recipe_ ? std::max(1, recipe_->coarse) : 1}};
    std::vector<Column> columns;
    make_figures(
        line_, runs, [](const FigureEntry& made, FigureContext& context) { return made.make(context); },
        [&](std::size_t, const FigureContext&, Figure figure) {
          for (Table& table : figure.tables)
            for (Column& column : table.columns) {
              column.name = table.name + "/" + column.name;
              columns.push_back(std::move(column));
            }
        },
        [&](const FigureProgress& made) { progress.update(progress_text(runs, made)); });
    return compare_figure(StoredFigure(Hdf5Reader(file_)), ColumnsInMemory(std::move(columns)), {});
  }

  const CommandLine& line_;
  std::string file_, kind_;
  TextAttributes attributes_;
  std::optional<Recipe> recipe_;
};

}  // namespace

int command_repro(const CommandLine& line, const ReproRequest& request) {
  const Repro repro(line, request.file);
  repro.print();
  if (!request.config.empty()) repro.write_config(request.config);
  if (!request.run) return kDone;
  std::fflush(stdout);
  const ResultComparison comparison = repro.again();
  print_comparison(comparison);
  return comparison.outcome == Outcome::same             ? kDone
         : comparison.outcome == Outcome::not_comparable ? kBadInput
                                                         : kCheckFailed;
}

}  // namespace remote_touch
