// The commands that tests compile with other compilers and options. They leave out figures and live runs.
#include <CLI/CLI.hpp>

#include "core/parameters/parameter.h"
#include "runners/interfaces/cli/program.h"

namespace remote_touch {

void require_own_kind(const std::string&, const std::string&) {}

int run_command_line(int argc, char** argv, CommandLine line, const Kernels& (*choose_kernels)()) {
  CLI::App app;
  app.require_subcommand(1);
  std::function<int()> act;
  int threads = 0;
  Subcommands commands{app, line, act, threads};
  add_run(commands);
  add_sweep(commands);
  add_baseline(commands);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    throw InputError(error.what(), "expected run or sweep NAME -o FILE, or baseline check");
  }
  line.quiet = true;
  line.kernels = &choose_kernels();
  return act();
}

}  // namespace remote_touch
