// The commands that make a file again: `repro` any stored result, `recover` a recording.
#include "runners/interfaces/cli/repro.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cinttypes>
#include <cstdio>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/hdf5_reader.h"
#include "analysis/storage/trace_comparison.h"
#include "runners/evaluation/regression/baselines.h"
#include "runners/evaluation/scorecard/scorecard.h"
#include "runners/experiment/sessions/session_file.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/interfaces/cli/figure.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep_answer.h"
#include "runners/sweep/sweep_run.h"

namespace remote_touch {
namespace {

struct ReproRequest {
  std::string file;
  bool run = false;
  std::string config;  // a file to write the configuration to; empty: none
};

struct RecoverRequest {
  std::string file;  // FILE.unfinished
  std::string output;
};

// Prints the text as comments of a shell script. Every line begins with '#', so a shell executes none.
void comment(const std::string& text) {
  std::string lines = "# ";
  for (const char c : text) lines += c == '\n' ? std::string("\n# ") : std::string(1, c);
  std::printf("%s\n", lines.c_str());
}

// Makes a stored result again with this program.
class Repro {
 public:
  Repro(const CommandLine& line, const std::string& file) : line_(line), result_(file) {
    if (result_.kind() == "figure" && of("figure") == kScorecardFigure)
      throw InputError(file, "is a scorecard, which " + of("command") +
                                 " -o FOLDER makes again: expected a file of its runs/");
  }

  // Prints comments about the build, and then the commands to type.
  void print() const {
    comment(result_.file() + ": version " + of("version") + ", " + commit_text(result_.attributes()) + ", " +
            of("compiler") + ", " + of("flags") + (of("isa").empty() ? "" : ", " + of("isa")));
    for (const auto& [name, value] : provenance("", "", line_.kernels->isa))
      if (name != "config" && name != "command" && !of(name.c_str()).empty() && of(name.c_str()) != value)
        comment("this program has another " + name + ": " + value);
    const std::string maker = other_maker(result_.attributes());
    if (!maker.empty()) comment("it " + maker);
    if (!of("input_digests").empty()) comment("it read:\n" + of("input_digests"));
    const Remaking again = result_.remaking();
    if (!again.reason.empty() && again.reason != maker) comment(again.reason);
    for (const std::string& command : again.commands) std::printf("%s\n", command.c_str());
  }

  void write_config(const std::string& target) const {
    if (result_.kind() == "figure")
      throw InputError("--config",
                       "a figure has no single configuration: expected a trace, a sweep or hashes");
    const std::string text = result_.config() + "\n";
    require_text(line_, target, {result_.file()}, text);
    write_file_atomically(target, text);
    std::printf("# configuration written to %s\n", target.c_str());
  }

  // Makes it again from its configuration and compares every number.
  ResultComparison again() const {
    Progress progress("repro", line_.quiet);
    const std::string& kind = result_.kind();
    ResultComparison result = kind == "trace"    ? trace_again(progress)
                              : kind == "hashes" ? hashes_again(progress)
                              : kind == "sweep"  ? sweep_again()
                                                 : figure_again(progress);
    result.baseline = result_.file(), result.candidate = "this program";
    return result;
  }

 private:
  std::string of(const char* name) const { return result_.of(name); }

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
    const Experiment experiment = result_.experiment();
    const ColumnsInMemory made(columns_again(experiment, progress));
    const StoredTrace stored(result_.file());
    return compare_trace(stored, result_.attributes(), made,
                         ours(experiment.to_json(), input_hashes(experiment.inputs())), {});
  }
  ResultComparison hashes_again(Progress& progress) const {
    const Experiment experiment = result_.experiment();
    const Column all = columns_again(experiment, progress).back();
    TickHashes made;
    for (const std::uint64_t hash : std::get<std::vector<std::uint64_t>>(all.values)) {
      made.tick.push_back(static_cast<std::int32_t>(made.tick.size()));
      made.hash.push_back(hash);
    }
    return compare_hashes(read_hashes(result_.file()),
                          {made, ours(experiment.to_json(), input_hashes(experiment.inputs()))});
  }
  ResultComparison sweep_again() const {
    const StoredSweep stored = read_stored_sweep(result_.file());
    if (!of("shard").empty() || stored.in_progress)
      throw InputError(result_.file(), "is a part of a sweep: expected a finished one, whole or merged");
    const Sweep sweep = result_.sweep();
    SweepRunOptions options;
    options.kernels = line_.kernels, options.stop = line_.stop;
    return compare_sweep(stored.result, stored.attributes, run_sweep(sweep, options),
                         ours(sweep.to_json(), input_hashes(sweep.inputs())), {});
  }
  ResultComparison figure_again(Progress& progress) const {
    if (of("figure") == kAnswerName)
      throw InputError(result_.file(),
                       "is an answer about a sweep: expected its own command, which `repro` "
                       "prints without --run");
    const auto is_it = [&](const FigureEntry& entry) { return entry.name == of("figure"); };
    const auto entry = std::find_if(figures().begin(), figures().end(), is_it);
    if (entry == figures().end())
      throw InputError(result_.file(), "is figure " + of("figure") + ", which this program does not know");
    const std::vector<FigureRun> runs = {
        {&*entry, result_.recipe() ? std::max(1, result_.recipe()->coarse) : 1}};
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
    return compare_figure(StoredFigure(Hdf5Reader(result_.file())), ColumnsInMemory(std::move(columns)), {},
                          true);
  }

  const CommandLine& line_;
  const StoredResult result_;
};

int command_repro(const CommandLine& line, const ReproRequest& request) {
  const Repro repro(line, request.file);
  repro.print();
  if (!request.config.empty()) repro.write_config(request.config);
  if (!request.run) return kDone;
  std::fflush(stdout);
  const ResultComparison comparison = repro.again();
  std::fputs(report_of(comparison).text().c_str(), stdout);
  return comparison.outcome == Outcome::same             ? kDone
         : comparison.outcome == Outcome::not_comparable ? kBadInput
                                                         : kCheckFailed;
}

int command_recover(const CommandLine& line, const RecoverRequest& request) {
  const FileLock lock = lock_output(line, request.output, {request.file});
  const UnfinishedSession made = recover_session(request.file, request.output);
  std::printf("%s: %" PRIu64 " ticks and %" PRIu64 " frames%s\n", printable(request.output).c_str(),
              made.ticks, made.frames, made.has_end ? "" : "; the recording was interrupted");
  if (made.left_out_bytes > 0)
    std::printf("  note: the last %" PRIu64
                " bytes of %s are left out, from the first damaged or incomplete block on\n",
                made.left_out_bytes, printable(request.file).c_str());
  std::printf("  %s is unchanged; remove it when you no longer need it\n", printable(request.file).c_str());
  return kDone;
}

}  // namespace

ResultComparison made_again(const CommandLine& line, const std::string& file) {
  return Repro(line, file).again();
}

void add_repro(Subcommands& commands) {
  auto [command, repro] = commands.add(
      "repro", "print the command that reproduces a result; with --run, run it and compare", command_repro);
  command->add_option("file", repro->file, "a trace, sweep or figure")->required();
  command->add_flag(
      "--run", repro->run,
      "run it again from the stored configuration and compare; exit code 0: the same, 1: different, 2: not "
      "comparable");
  command->add_option("--config", repro->config, "write the stored configuration to this JSON file");
}

void add_recover(Subcommands& commands) {
  auto [recover, kept] =
      commands.add("recover", "make a recording from the file that an interrupted live session has left",
                   command_recover, kNoThreads);
  recover
      ->add_option("file", kept->file, "FILE.unfinished, which live --record FILE leaves; it is not changed")
      ->required();
  recover->add_option("-o,--output", kept->output, "the HDF5 file to write")->required();
}

}  // namespace remote_touch
