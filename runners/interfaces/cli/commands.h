// The subcommands. Each prints results on stdout, reports errors as exceptions, and returns the exit code.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"

namespace remote_touch {

struct Column;
struct Hdf5Content;

// kChanged is returned only by `compare`: the results differ and nothing got worse.
enum ExitCode { kDone = 0, kCheckFailed = 1, kBadInput = 2, kInterrupted = 3, kChanged = 4 };

// Options and signals that all commands share.
struct CommandLine {
  bool quiet = false;
  bool force = false;                     // overwrite files that are not results of this program
  std::vector<std::string> plugins = {};  // the files of --plugin
  const Kernels* kernels = nullptr;
  const std::atomic<bool>* stop = nullptr;  // set by SIGINT and SIGTERM
  // Set by SIGUSR1 and SIGUSR2; the code that responds resets them.
  std::atomic<bool>* report = nullptr;
  std::atomic<bool>* rearm = nullptr;
};

// Prints a line on standard error for each --set that a later --set replaces (changed_settings.h): only the
// last one has an effect, and the user may have meant another parameter. Call it at the end of a command, so
// that an error stays one line; command_live() calls it before its loop.
void print_replaced(const std::vector<std::string>& overrides);

struct ListRequest {
  std::vector<std::string> kind;  // words of a kind, such as {"fixture", "rules"}; empty: all kinds
};
int command_list(const CommandLine& line, const ListRequest& request);

struct DescribeRequest {
  std::string name;  // a name, or NAME.PARAMETER
};
int command_describe(const CommandLine& line, const DescribeRequest& request);

struct RunRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  std::string output;
  bool timing = false;
  bool strict = false;
  bool all = false;  // prints all measures
};
int command_run(const CommandLine& line, const RunRequest& request);

struct FigureRequest {
  std::vector<std::string> names;
  std::string folder;
  int coarse = 1;      // uses every coarse-th value of a map's axes
  bool quick = false;  // uses coarse maps where a map takes minutes
  std::vector<std::string> overrides;
};
int command_figure(const CommandLine& line, const FigureRequest& request);

struct SweepRequest {
  std::string sweep;
  std::vector<std::string> overrides;
  std::string output;  // {shard} in it is replaced by the shard, "3of7"
  std::string shard;   // empty: from the environment, else the whole sweep
  int threads = 0;     // 0: as OpenMP decides
  bool dry_run = false;
  bool strict = false;
};
int command_sweep(const CommandLine& line, const SweepRequest& request);

struct ScorecardRequest {
  std::vector<std::string> methods, scenes;  // empty: all
  std::string folder;
  int seeds = 10;
  int threads = 0;    // 0: as OpenMP decides
  bool view = false;  // also make pages of the failures
};
int command_scorecard(const CommandLine& line, const ScorecardRequest& request);

inline constexpr const char* kStoredCard = "data/scorecard.h5";

struct ScorecardStoreRequest : ScorecardRequest {
  std::string file = kStoredCard;
};
int command_scorecard_store(const CommandLine& line, const ScorecardStoreRequest& request);

struct ScorecardCheckRequest {
  std::vector<std::string> methods, scenes;  // empty: all that are stored
  std::string folder;
  std::string file = kStoredCard;
  int threads = 0;
};
int command_scorecard_check(const CommandLine& line, const ScorecardCheckRequest& request);

struct ScorecardSummaryRequest {
  std::string file = kStoredCard;
};
int command_scorecard_summary(const CommandLine& line, const ScorecardSummaryRequest& request);

struct MergeCommand {
  std::vector<std::string> shards;
  std::string output;
  bool partial = false;
};
int command_merge(const CommandLine& line, const MergeCommand& command);

// See SweepQuestion in runners/sweep/sweep_answer.h.
struct AnalyseRequest {
  std::string sweep;
  std::string limit, along, between, direction;  // empty: chosen
  double threshold = 0.5, level = 0.5;
  std::vector<std::string> means, differences, by;
  std::string output;  // .h5 or .csv; empty: none
};
int command_analyse(const CommandLine& line, const AnalyseRequest& request);

struct ReplayRequest {
  std::string sweep;
  std::string cell;  // "3,4"
  int replicate = 0;
  std::string output;
  bool strict = false;
};
int command_replay(const CommandLine& line, const ReplayRequest& request);

struct RecheckRequest {
  std::vector<std::string> sweeps;  // finished sweeps, or shards
};
int command_recheck(const CommandLine& line, const RecheckRequest& request);

struct CompareRequest {
  std::string baseline, candidate;
  std::vector<std::string> tolerances;  // "force=1e-9,1e-6"
  bool paired = false;
  double margin = 0.02, shift_margin = 0.1, alpha = 0.01;
  std::string json, junit, plot, view;  // files to write; empty: none
};
int command_compare(const CommandLine& line, const CompareRequest& request);

struct BaselineCheckRequest {
  std::vector<std::string> names;  // empty: all, and none may be missing
  std::string folder = "data/baselines";
  std::string json, junit;
};
int command_baseline_check(const CommandLine& line, const BaselineCheckRequest& request);

struct BaselineBlessRequest {
  std::vector<std::string> names;
  std::string reason;
  std::string folder = "data/baselines";
  std::string run, sweep;
  std::vector<std::string> overrides, also;
  bool one_compiler = false;
};
int command_baseline_bless(const CommandLine& line, const BaselineBlessRequest& request);

struct VerifyRequest {
  std::vector<std::string> renderers;  // empty: all
  std::vector<std::string> overrides;  // "r1_m=0.004"
  std::string junit;
};
int command_verify(const CommandLine& line, const VerifyRequest& request);

struct ReproRequest {
  std::string file;
  bool run = false;
  std::string config;  // a file to write the configuration to; empty: none
};
int command_repro(const CommandLine& line, const ReproRequest& request);

struct CiteRequest {
  std::string file;  // empty: the program itself
};
int command_cite(const CommandLine& line, const CiteRequest& request);

struct HashesRequest {
  std::string trace;
  int every = 1;
  std::string output;
};
int command_hashes(const CommandLine& line, const HashesRequest& request);

struct LiveRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  std::string device, depth = "sim:";  // empty device: browser: if view, else sim:
  std::string record, output, report;  // files to write; empty: none
  std::optional<double> duration_s;    // none: until a signal comes
  bool strict = false;
  bool view = false;  // shows the run in a browser
  int view_port = 0;
};
int command_live(const CommandLine& line, const LiveRequest& request);

struct RecoverRequest {
  std::string file;  // FILE.unfinished
  std::string output;
};
int command_recover(const CommandLine& line, const RecoverRequest& request);

struct CacheRequest {
  std::optional<double> max_MB;  // none: nothing is removed
};
int command_cache(const CommandLine& line, const CacheRequest& request);

struct DevicesRequest {};
int command_devices(const CommandLine& line, const DevicesRequest& request);

struct JitterRequest {
  double duration_s = 10, rate_hz = 1000;
};
int command_jitter(const CommandLine& line, const JitterRequest& request);

struct ViewRequest {
  std::vector<std::string> results;  // a trace, two to compare, or a sweep
  std::vector<std::string> cells;    // cells of a sweep; empty: sweep_page() chooses them
  std::string output;
  double max_MB = 20;
  std::string claims = {};  // claims.json of figures; empty: none
};
void write_view(const CommandLine& line, const ViewRequest& request);
int command_view(const CommandLine& line, const ViewRequest& request);

struct ExportRequest {
  std::string file;
  std::string output;  // its ending is the format
};
int command_export(const CommandLine& line, const ExportRequest& request);

struct InspectRequest {
  std::string file;
};
int command_inspect(const CommandLine& line, const InspectRequest& request);
// Prints how far the shards of a sweep in a folder are.
int inspect_folder(const std::string& folder);
// Prints the runs and the measures of a tally, and the extent, unit, meaning and values of each of its
// arrays. content: the content of the file.
void print_tally(const std::string& file, const Hdf5Content& content);
// Prints the values of a column and ends the line: the range and the mean of numbers, the counts of names,
// the number of texts that are not empty and the first of them, or the last of hashes.
void print_values(const Column& column);

}  // namespace remote_touch
