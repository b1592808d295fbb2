// The commands that tests compile with other compilers and options. They leave out figures, live runs and
// CLI11.
#include <string>
#include <vector>

#include "core/parameters/input_error.h"
#include "runners/interfaces/cli/program.h"

namespace remote_touch {

namespace {

constexpr const char* kUsage =
    "expected run|sweep NAME [--set PARAMETER=VALUE]... -o FILE, baseline check --folder FOLDER";

struct Words {
  std::vector<std::string> plain, overrides;
  std::string output, folder;
};

Words read(int argc, char** argv) {
  Words words;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word != "-o" && !word.starts_with("--")) {
      words.plain.push_back(word);
      continue;
    }
    if (++i == argc) throw InputError(word, kUsage);
    if (word == "-o")
      words.output = argv[i];
    else if (word == "--folder")
      words.folder = argv[i];
    else if (word == "--set")
      words.overrides.emplace_back(argv[i]);
    else
      throw InputError(word, kUsage);
  }
  if (words.plain.size() != 2) throw InputError("command", kUsage);
  return words;
}

}  // namespace

int run_command_line(int argc, char** argv, CommandLine line, const Kernels& (*choose_kernels)()) {
  const Words words = read(argc, argv);
  line.quiet = true;
  line.kernels = &choose_kernels();
  const std::string &command = words.plain[0], &name = words.plain[1];
  if (command == "run") return command_run(line, {name, words.overrides, words.output});
  if (command == "sweep") {
    SweepRequest request;
    request.sweep = name;
    request.overrides = words.overrides;
    request.output = words.output;
    return command_sweep(line, request);
  }
  if (command == "baseline" && name == "check") {
    BaselineCheckRequest request;
    request.folder = words.folder;
    return command_baseline_check(line, request);
  }
  throw InputError(command, kUsage);
}

}  // namespace remote_touch
