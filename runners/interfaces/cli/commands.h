// The parts that subcommands share, and those that tests or other commands call. Each command prints results
// on stdout, reports errors as exceptions, and returns the exit code.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"

namespace remote_touch {

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

struct MergeCommand {
  std::vector<std::string> shards;
  std::string output;
  bool partial = false;
};
int command_merge(const CommandLine& line, const MergeCommand& command);

struct HashesRequest {
  std::string trace;
  int every = 1;
  std::string output;
};
int command_hashes(const CommandLine& line, const HashesRequest& request);

struct ViewRequest {
  std::vector<std::string> results;  // a trace, two to compare, or a sweep
  std::vector<std::string> cells;    // cells of a sweep; empty: sweep_page() chooses them
  std::string output;
  double max_MB = 20;
  std::string claims = {};  // claims.json of figures; empty: none
};
void write_view(const CommandLine& line, const ViewRequest& request);

}  // namespace remote_touch
