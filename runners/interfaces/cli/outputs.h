// The outputs of a command: which files it may overwrite, its progress on stderr, the summary of a sweep, and
// lines that fit into a terminal.
#pragma once

#include <chrono>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/storage/other_processes.h"
#include "analysis/sweeps/sweep_result.h"
#include "analysis/sweeps/sweep_tally.h"
#include "runners/interfaces/cli/program.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

// Locks the output until the lock is destroyed. Throws InputError, before any work is done for the output,
// unless the result can be written there. The folder must be writable. The output must be none of the inputs
// and no plug-in. An existing file must be a result of this program, an empty file or /dev/null, unless
// --force is given. No other process may be writing it. An unfinished recording is never overwritten, not
// even with --force. The rule for existing files is checked again when the result is written.
[[nodiscard]] FileLock lock_output(const CommandLine& line, const std::string& output,
                                   const std::vector<std::string>& inputs);

// The same without a lock.
void require_result(const CommandLine& line, const std::string& output,
                    const std::vector<std::string>& inputs);

// The same for a text report, without a lock: an existing file may be replaced if it begins with `opening`.
void require_report(const CommandLine& line, const std::string& output,
                    const std::vector<std::string>& inputs, const std::string& opening);

// The same for a file that this command has written before with the same text.
void require_text(const CommandLine& line, const std::string& output, const std::vector<std::string>& inputs,
                  const std::string& text);

// The same for a file of an export.
void require_export(const CommandLine& line, const std::string& output,
                    const std::vector<std::string>& inputs, const std::string& opening);

// An option of one command and the file that it names; the file is empty if the option was not given.
// require_distinct() throws InputError if two options name one file, however its path is written, because one
// result would be lost. /dev/null may be named twice.
struct OutputOption {
  const char* option;
  std::string file;
};
void require_distinct(const std::vector<OutputOption>& outputs);

inline constexpr const char* kJsonReport = "{\n  \"baseline\":";
inline constexpr const char* kJsonReports = "[\n  {\n    \"baseline\":";
inline constexpr const char* kClaims = "[\n  {\n    \"figure\":";
inline constexpr const char* kFigureProgress = "{\n \"left_s\":";
inline constexpr const char* kScorecardJson = "{\n \"schema\": \"remote-touch-scorecard/";
inline constexpr const char* kJunitReport = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
inline constexpr const char* kPage = "<!DOCTYPE html>\n<!-- remote-touch view -->";

// The files of an experiment: its own and those that it reads.
std::vector<std::string> with_parts(const std::string& subject, const std::vector<InputPart>& parts);

// Progress on stderr, apart from results on stdout.

// Returns "25 %, 2.5 %/s, 30 s left"; only "25 %" if the fraction or the time is 0.
std::string progress_text(double fraction, double elapsed_s);
// The same for counted things. `earlier` of them were done before this program began: "30 of 100 runs, 2/s,
// 35 s left".
std::string progress_text(std::size_t done, std::size_t total, std::size_t earlier, const char* things,
                          double elapsed_s);

// Overwrites one line on a terminal, and prints a line every ten seconds elsewhere. Only one thread at a time
// may use it.
class Progress {
 public:
  // Prints all later progress as JSON for other programs, one object in a line, at most once a
  // second:
  //   {"what": "map.json", "done": 30, "total": 100, "elapsed_s": 15.2, "left_s": 35.4}
  // done and total are missing where there is only a text, left_s where it is not known.
  static void use_json() { is_json_ = true; }
  Progress(std::string what, bool quiet);
  ~Progress();
  void update(double fraction);  // 0 to 1
  void update(const std::string& text);
  void clear();  // call it before something else is printed
  void update(std::size_t done, std::size_t total, std::size_t earlier, const char* things);

 private:
  bool is_due();
  void print_json(nlohmann::ordered_json json) const;
  double elapsed_s() const { return std::chrono::duration<double>(last_ - start_).count(); }
  void show(const std::string& text);
  static inline bool is_json_ = false;
  std::string what_;
  bool quiet_, terminal_, shown_ = false;
  std::chrono::steady_clock::time_point start_, last_;
};

// The texts that the commands about sweeps print.

std::string extent_text(const SweepGrid& grid);  // "76 x 71"

// Prints the cells, the runs, the mean and range of each measure, and the number of runs with each kind of
// note. Returns kDone, or kCheckFailed if a run failed.
int print_summary(const std::string& file, const SweepResult& result);

// Prints the cells, the runs, the mean and range of each measure over all runs, the number of runs with each
// kind of note, and the first failed run of each cell. Returns kDone, or kCheckFailed if a run failed.
int print_summary(const std::string& file, const SweepTally& tally);

// Returns a line on the cells whose replicates are equal, because they draw no random numbers. grid: of the
// sweep with this configuration (JSON). Empty if each cell has one run, and for more than 1e6 cells.
std::string note_on_equal_runs(const SweepGrid& grid, const std::string& config);

// Returns, for example, "mean 0.25 0 .. 1 1, median 0, of 4 of 5 runs": mean, range, unit, median, and how
// many runs have a finite value.
std::string measure_text(const MeasureTally& all, const std::string& units);

// The summary of a sweep whose runs come in blocks; prints what print_summary() prints.
class SweepSummary {
 public:
  explicit SweepSummary(SweepGrid grid) : grid_(std::move(grid)), ranges_(grid_.measures.size()) {}
  // block: a part of the sweep, or all of it. The blocks come in increasing order of their runs.
  void add(const SweepResult& block);
  int print(const std::string& file, const std::string& digest) const;

 private:
  // The finite values of a measure.
  struct Range {
    double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0;
    std::size_t count = 0;
  };
  std::string text_of(const Range& range, const std::string& units) const;
  void add_notes(const std::vector<NoteCount>& counts);
  SweepGrid grid_;
  std::size_t held_ = 0, done_ = 0, failed_ = 0, elsewhere_ = 0;
  int rounds_ = 0;                     // 0 without refinement
  std::vector<Range> ranges_;          // one for each measure
  std::vector<std::string> failures_;  // the first of them
  std::vector<NoteCount> notes_;
};

// Breaks a line at spaces into lines of at most `width` characters, each of which ends with a line feed. A
// word that is longer than a line stays whole. Later lines begin below the last column of a table if that is
// in the left half, else two spaces further than the first one. Characters are those of UTF-8.
std::string wrapped(std::string_view line, std::size_t width);

// If standard output is a terminal, wraps all lines that are printed by the C library from now on, at the
// width of the terminal; at 80 characters if the width is not known. Nothing changes for a file or a pipe.
void wrap_standard_output();

}  // namespace remote_touch
