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

#include <functional>

#include "core/kernels/kernels.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/interfaces/cli/commands.h"

namespace remote_touch {

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
