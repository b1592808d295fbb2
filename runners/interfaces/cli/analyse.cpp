// Answers questions about a finished sweep: limits, means and differences, as text, CSV or HDF5.
#include <cstdio>
#include <filesystem>

#include "analysis/figures/result_file.h"
#include "analysis/tally/tally_file.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/interfaces/cli/commands.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/presentation/export/csv_files.h"
#include "runners/sweep/answer_panels.h"
#include "runners/sweep/answer_text.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep_answer.h"
#include "runners/sweep/sweep_notes.h"

namespace remote_touch {

namespace {

SweepQuestion question_of(const AnalyseRequest& request) {
  return {request.limit, request.along,       request.threshold, request.level,    request.means,
          request.by,    request.differences, request.between,   request.direction};
}

// Returns the command without the output.
std::string command_of(const AnalyseRequest& request) {
  std::vector<std::string> words = program_words();
  words.insert(words.end(), {"analyse", request.sweep});
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {option, value});
  };
  const auto add_number = [&](const char* option, double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", value);
    if (value != 0.5) add(option, text);
  };
  add("--limit", request.limit), add("--along", request.along);
  add_number("--above", request.threshold), add_number("--level", request.level);
  for (const std::string& measure : request.means) add("--mean", measure);
  for (const std::string& axis : request.by) add("--by", axis);
  for (const std::string& measure : request.differences) add("--difference", measure);
  add("--between", request.between), add("--direction", request.direction);
  return shell_command(words);
}

struct Answer {
  Figure figure;
  std::string config, digest;       // configuration and digest of the sweep
  std::size_t done = 0, asked = 0;  // runs that are finished, and that the sweep should have
  std::vector<std::string> notes;
  std::string distrust = {};  // see distrust_of()
};

Answer answer_of_runs(const AnalyseRequest& request) {
  const StoredSweep stored = read_stored_sweep(request.sweep);
  const SweepResult& result = stored.result;
  const std::string config = attribute(stored.attributes, "config"), damage = damage_text(stored);
  std::vector<std::string> notes = note_lines(result);
  if (!damage.empty()) notes.push_back(damage);
  return {sweep_answer(result, config, question_of(request)),
          config,
          digest(result),
          result.runs_in(RunState::done).size(),
          result.run_count() - result.runs_in(RunState::not_sampled).size(),
          std::move(notes)};
}

Answer answer_of_tally(const AnalyseRequest& request) {
  const StoredTally stored = read_tally(Hdf5Reader(request.sweep));
  const SweepTally& tally = stored.tally;
  std::int64_t done = 0;
  for (const CellTally& cell : tally.tallies) done += cell.done;
  const std::string config = attribute(stored.attributes, "config");
  std::vector<std::string> notes = note_lines(tally);
  const std::string distrust = distrust_of(stored.attributes);
  if (!distrust.empty()) notes.push_back(distrust);
  return {sweep_answer(tally, config, question_of(request)),
          config,
          digest(tally),
          static_cast<std::size_t>(done),
          static_cast<std::size_t>(tally.run_count()),
          std::move(notes),
          distrust};
}

void write_hdf5(const CommandLine& line, const AnalyseRequest& request, const Answer& answer) {
  const FileLock lock = lock_output(line, request.output, {request.sweep});
  TextAttributes attributes = provenance(answer.config, command_of(request), "");
  attributes.emplace_back("sweep_digest", answer.digest);
  Figure figure = answer.figure;
  if (!answer.distrust.empty()) figure.caption += (figure.caption.empty() ? "" : " ") + answer.distrust + ".";
  write_figure(request.output, figure, attributes);
}

// Writes the tables without those of single curves, whose rows the others have, too.
void write_tables(const CommandLine& line, const AnalyseRequest& request, const Figure& answer) {
  std::vector<Table> tables = answer.tables;
  std::erase_if(tables, [&](const Table& table) { return is_of_curve(answer, table); });
  const FileLock lock(request.output);
  NewFiles files("the tables");
  const auto require_allowed = [&](const std::filesystem::path& file, const std::string& opening) {
    require_export(line, file.string(), {request.sweep}, opening);
  };
  const Hdf5Reader sweep(request.sweep);
  write_csv(tables, {sweep, request.output, files, require_allowed, line.kernels, line.stop});
  files.finish();
}

}  // namespace

int command_analyse(const CommandLine& line, const AnalyseRequest& request) {
  const std::string ending = std::filesystem::path(request.output).extension().string();
  if (!request.output.empty() && ending != ".h5" && ending != ".csv")
    throw InputError("--output " + request.output, "expected a file that ends with .h5 or .csv");
  const Answer answer =
      is_tally(Hdf5Reader(request.sweep)) ? answer_of_tally(request) : answer_of_runs(request);
  if (ending == ".h5") write_hdf5(line, request, answer);
  if (ending == ".csv") write_tables(line, request, answer.figure);
  std::fputs(answer_text(answer.figure, answer.done, answer.asked).c_str(), stdout);
  for (const std::string& note : answer.notes) std::printf("  note: %s\n", note.c_str());
  return kDone;
}

}  // namespace remote_touch
