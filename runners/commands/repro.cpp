#include <cstdio>

#include "analysis/column_source.h"
#include "analysis/fingerprint.h"
#include "analysis/result_file.h"
#include "analysis/sweep_file.h"
#include "analysis/tick_hashes.h"
#include "analysis/whole_file.h"
#include "core/input_error.h"
#include "runners/commands/commands.h"
#include "runners/commands/progress.h"
#include "runners/commands/shell_command.h"
#include "runners/comparison/comparison_text.h"
#include "runners/configuration_difference.h"
#include "runners/figures/figures.h"
#include "runners/input_hashes.h"
#include "runners/provenance.h"
#include "runners/sweep_run.h"

namespace remote_touch {

namespace {

// A stored result, and the program's own build to hold against it.
class Repro {
 public:
  Repro(const CommandLine& line, const std::string& file)
      : line_(line), file_(file), kind_(kind_of(file)), attributes_(Hdf5Reader(file).attributes()) {}

  std::string of(const char* name) const { return attribute(attributes_, name); }

  // Comments about the build, then what to type.
  void print() const {
    std::printf("# %s: version %s, commit %s%s, %s, %s%s%s\n", file_.c_str(), of("version").c_str(),
                of("git_commit").c_str(), of("git_dirty") == "yes" ? " with local changes" : "",
                of("compiler").c_str(), of("flags").c_str(), of("isa").empty() ? "" : ", ",
                of("isa").c_str());
    for (const auto& [name, value] : provenance("", "", line_.kernels->isa))
      if (name != "config" && name != "command" && !of(name.c_str()).empty() && of(name.c_str()) != value)
        std::printf("# this program has another %s: %s\n", name.c_str(), value.c_str());
    if (!of("inputs").empty()) std::printf("# it read:\n# %s\n", of("inputs").c_str());
    if (kind_ == "figure" || command_makes_it())
      print_command();
    else
      std::printf(
          "# its command no longer makes this configuration (another file, or another default)\n"
          "%s\n%s -o again.h5\n",
          shell_command({"remote-touch", "repro", file_, "--config", "again.json"}).c_str(),
          shell_command({"remote-touch", kind_ == "sweep" ? "sweep" : "run", "again.json"}).c_str());
  }

  void write_config(const std::string& target) const {
    if (kind_ == "figure")
      throw InputError("--config", "of a figure; allowed with a trace, a sweep or hashes");
    const std::string text = of("config") + "\n";
    write_whole_file(target, text.data(), text.size());
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
  // A replay's command is that of its sweep, and then its own.
  std::vector<std::vector<std::string>> commands() const {
    const std::string all = of("command"), mark = "; ";
    const std::size_t cut = all.find(mark);
    if (cut == std::string::npos) return {words_of(all)};
    return {words_of(all.substr(0, cut)), words_of(all.substr(cut + mark.size()))};
  }
  void print_command() const {
    auto all = commands();
    if (kind_ == "figure") {
      all[0].insert(all[0].end(), {"-o", "again"});
    } else {
      all[0].insert(all[0].end(), {"-o", all.size() > 1 ? "map.h5" : "again.h5"});
      if (!of("shard").empty()) all[0].insert(all[0].end(), {"--shard", of("shard")});
    }
    std::printf("%s\n", shell_command(all[0]).c_str());
    if (all.size() < 2) return;
    all[1].insert(all[1].begin() + 2, "map.h5");
    all[1].insert(all[1].end(), {"-o", "again.h5"});
    std::printf("%s\n", shell_command(all[1]).c_str());
  }

  // remote-touch run|sweep SUBJECT --set a=b ...
  bool command_makes_it() const {
    const auto all = commands();
    if (all.size() > 1) return true;  // a cell: its sweep's file tells whether it is the same
    const std::vector<std::string>& words = all.front();
    if (words.size() < 3) return false;
    std::vector<std::string> overrides;
    for (std::size_t i = 4; i < words.size(); i += 2) overrides.push_back(words[i]);
    try {
      const std::string now = words[1] == "sweep" ? Sweep::load(words[2], overrides).to_json()
                                                  : Experiment::load(words[2], overrides).to_json();
      return configuration_differences(of("config"), now).empty();
    } catch (const InputError&) {
      return false;
    }
  }

  std::vector<Column> columns_again(const Experiment& experiment, Progress& progress) const {
    SimulationOptions options;
    options.kernels = line_.kernels, options.stop = line_.stop, options.hash_frames = true;
    options.progress = [&](double share) { progress.update(share); };
    return simulate(experiment, options).columns();
  }
  TextAttributes ours(const std::string& config, const std::string& inputs) const {
    return provenance(config, of("command"), of("isa").empty() ? "" : line_.kernels->isa, inputs);
  }

  ResultComparison trace_again(Progress& progress) const {
    const Experiment experiment = Experiment::from_json(of("config"), file_ + " config");
    const ColumnsInMemory made(columns_again(experiment, progress));
    const StoredTrace stored(file_);
    return compare_trace(stored, attributes_, made,
                         ours(experiment.to_json(), input_hashes(experiment.inputs())), {});
  }
  ResultComparison hashes_again(Progress& progress) const {
    const Experiment experiment = Experiment::from_json(of("config"), file_ + " config");
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
    const StoredSweep stored = read_sweep(file_);
    if (!of("shard").empty() || stored.in_progress)
      throw InputError(file_, "is a part of a sweep; allowed a finished one, whole or merged");
    const Sweep sweep = Sweep::from_json(of("config"), file_ + " config");
    SweepRunOptions options;
    options.kernels = line_.kernels, options.stop = line_.stop;
    return compare_sweep(stored.result, stored.attributes, run_sweep(sweep, options),
                         ours(sweep.to_json(), input_hashes(sweep.inputs())), {});
  }
  ResultComparison figure_again(Progress& progress) const {
    for (const FigureEntry& entry : figures()) {
      if (entry.name != of("figure")) continue;
      const Laboratory laboratory(*line_.kernels, line_.stop, [&](double share) { progress.update(share); });
      std::vector<Column> columns;
      for (const Table& table : entry.make(laboratory).tables)
        for (Column column : table.columns) {
          column.name = table.name + "/" + column.name;
          columns.push_back(std::move(column));
        }
      return compare_figure(StoredFigure(file_), ColumnsInMemory(std::move(columns)), {});
    }
    throw InputError(file_, "is figure " + of("figure") + ", which this program does not know");
  }

  const CommandLine& line_;
  std::string file_, kind_;
  TextAttributes attributes_;
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
  return static_cast<int>(comparison.outcome);
}

}  // namespace remote_touch
