// The subcommands. Each prints results on stdout, trouble as exceptions, and returns the exit code.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "core/kernels.h"

namespace remote_touch {

enum ExitCode { kDone = 0, kCheckFailed = 1, kBadInput = 2, kInterrupted = 3 };

// What every command shares.
struct CommandLine {
  bool quiet = false;
  const Kernels* kernels = nullptr;
  const std::atomic<bool>* stop = nullptr;  // set by SIGINT and SIGTERM
};

int command_list();
int command_describe(const std::string& name);

struct RunRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  std::string output;
  bool timing = false;
};
int command_run(const CommandLine& line, const RunRequest& request);

struct FigureRequest {
  std::vector<std::string> names;
  std::string folder;
};
int command_figure(const CommandLine& line, const FigureRequest& request);

int command_inspect(const std::string& file);

}  // namespace remote_touch
