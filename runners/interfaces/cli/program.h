// A whole program from a catalog: every command, with the entries of the catalog beside those of this
// project.
//
//   void add_entries(remote_touch::Catalog& catalog) {
//     catalog.add(remote_touch::renderer_entry<Mine>("mine", ...));
//   }
//   int main(int argc, char** argv) {
//     return remote_touch::command_line(add_entries, argc, argv);
//   }
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "core/kernels/kernels.h"
#include "runners/experiment/catalog/catalog.h"

// NOLINTNEXTLINE(readability-identifier-naming): the name that CLI11 has
namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace remote_touch {

// The parts that subcommands share, and those that tests or other commands call. Each command prints results
// on stdout, reports errors as exceptions, and returns the exit code.

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

// Throws InputError unless --every is 1 or more.
void require_every(int every);

// Returns the title of a result: a figure has one of its own, others have that of their configuration. Empty
// if there is none.
std::string title_of(const std::string& file, const TextAttributes& attributes);

// A subcommand is a line in the list below, and one file with the request, the work and the options.

// The threads of a command that has no option for them: as OpenMP decides, or none.
inline constexpr int kUsualThreads = 0, kNoThreads = -1;

// Adds subcommands to `app`. When the user calls one of them, `act` becomes the call of its function, and
// `threads` becomes the number of threads that it starts. The request, which the options fill, lives as long
// as `act`.
struct Subcommands {
  CLI::App& app;
  CommandLine& line;
  std::function<int()>& act;
  int& threads;

  template <class Request>
  std::pair<CLI::App*, Request*> add(const char* name, const char* meaning,
                                     int (*run)(const CommandLine&, const Request&),
                                     int usual_threads = kUsualThreads) {
    auto request = std::make_shared<Request>();
    const auto threads_wanted = [request, usual_threads] {
      if constexpr (requires { request->threads; })
        return request->threads;
      else
        return usual_threads;
    };
    CLI::App* command =
        declare(name, meaning, threads_wanted, [&line = line, request, run] { return run(line, *request); });
    return {command, request.get()};
  }
  // threads_wanted() is called and `act` becomes `start` when the user calls this command itself, but not
  // when the user calls a subcommand of it.
  CLI::App* declare(const char* name, const char* meaning, std::function<int()> threads_wanted,
                    std::function<int()> start);
};

// Accepts numbers from low to high. Rejects NaN, which CLI::Range accepts.
CLI::Validator between(double low, double high);

void add_set(CLI::App* command, std::vector<std::string>& overrides, const char* meaning);

// Prints a line on standard error for each --set that a later --set replaces (changed_settings.h): only the
// last one has an effect, and the user may have meant another parameter. Call it at the end of a command, so
// that an error stays one line; command_live() calls it before its loop.
void print_replaced(const std::vector<std::string>& overrides);

// Returns "is a sweep: expected `remote-touch sweep NAME -o FILE`" if the name is not a file, and is a stored
// name that this command does not accept. Returns an empty text otherwise. command: run, sweep or figure.
std::string other_kind(const std::string& name, const std::string& command);
// Throws InputError with this text.
void require_own_kind(const std::string& name, const std::string& command);

// The commands in the order of --help, in the groups that it shows. add_run() adds `run`, and so on.
// clang-format off
#define REMOTE_TOUCH_COMMANDS(GROUP, COMMAND) \
  GROUP("what there is") COMMAND(list) COMMAND(describe) COMMAND(devices) \
  GROUP("make results") COMMAND(run) COMMAND(sweep) COMMAND(merge) COMMAND(figure) COMMAND(scorecard) \
  GROUP("look at results") COMMAND(view) COMMAND(inspect) COMMAND(analyse) COMMAND(export) COMMAND(cite) \
  GROUP("check results") COMMAND(compare) COMMAND(replay) COMMAND(recheck) COMMAND(repro) COMMAND(hashes) \
    COMMAND(baseline) COMMAND(verify) \
  GROUP("in real time") COMMAND(live) COMMAND(recover) COMMAND(jitter) \
  GROUP("others") COMMAND(cache)
// clang-format on
#define GROUP(name)
#define COMMAND(name) void add_##name(Subcommands& commands);
REMOTE_TOUCH_COMMANDS(GROUP, COMMAND)
#undef COMMAND
#undef GROUP

// Parses the arguments and runs the command. Returns the exit code; throws InputError for arguments that are
// not understood. choose_kernels is called once, before a command runs.
int run_command_line(int argc, char** argv, CommandLine line, const Kernels& (*choose_kernels)());

// Executes the command line and returns the exit code: 0 done, 1 a check failed, 2 an input that cannot be
// used, 3 interrupted, 4 `compare` found differences and nothing got worse. Prints errors as one line on
// standard error; throws nothing. Handles SIGINT, SIGTERM, SIGHUP, SIGUSR1 and SIGUSR2. If the catalog has
// entries that are not built in, results record the program's name (argv[0] without its folder) and the
// SHA-256 of its file.
int command_line(Catalog catalog, int argc, char** argv);
// The same with the built-in catalog and the entries that the function adds. An exception that the function
// throws is handled as such an error, too.
int command_line(const std::function<void(Catalog&)>& add_entries, int argc, char** argv);

}  // namespace remote_touch
