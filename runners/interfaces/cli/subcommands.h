// The subcommands of the command line. Each add_commands_...() declares the options of some commands, and the
// function that each command starts.
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

// Returns the number of threads of a command that has no option for it. 0: OpenMP decides; -1: the command
// starts none.
int usual_threads(const std::string& command);
template <class Request>
int threads_of(const std::string& command, const Request& request) {
  if constexpr (requires { request.threads; })
    return request.threads;
  else
    return usual_threads(command);
}

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
                                     int (*run)(const CommandLine&, const Request&)) {
    auto request = std::make_shared<Request>();
    CLI::App* command = declare(
        name, meaning, [name, request] { return threads_of(name, *request); },
        [&line = line, request, run] { return run(line, *request); });
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

// list, describe, view, export, inspect, run, sweep, merge, replay, analyse, figure.
void add_commands_of_experiments(Subcommands& commands);
// scorecard, compare, hashes, baseline, repro, cite, verify.
void add_commands_of_comparisons(Subcommands& commands);
// live, recover, devices, jitter, cache.
void add_commands_of_machines(Subcommands& commands);

}  // namespace remote_touch
