// The subcommands of the command line: a line in the list below, and one file with the request, the work and
// the options of each.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "runners/interfaces/cli/commands.h"

// NOLINTNEXTLINE(readability-identifier-naming): the name that CLI11 has
namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace remote_touch {

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

// The commands in the order of --help. add_run() adds `run`, and so on.
// clang-format off
#define REMOTE_TOUCH_COMMANDS(COMMAND) \
  COMMAND(list) COMMAND(describe) COMMAND(view) COMMAND(export) COMMAND(inspect) \
  COMMAND(run) COMMAND(sweep) COMMAND(merge) COMMAND(replay) COMMAND(recheck) COMMAND(analyse) \
  COMMAND(figure) COMMAND(scorecard) COMMAND(compare) COMMAND(hashes) COMMAND(baseline) \
  COMMAND(repro) COMMAND(cite) COMMAND(verify) COMMAND(live) COMMAND(recover) COMMAND(devices) \
  COMMAND(jitter) COMMAND(cache)
// clang-format on
#define COMMAND(name) void add_##name(Subcommands& commands);
REMOTE_TOUCH_COMMANDS(COMMAND)
#undef COMMAND

}  // namespace remote_touch
