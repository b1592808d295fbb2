// The command line: options, help, and which command they select.
#pragma once

#include "core/kernels/kernels.h"
#include "runners/interfaces/cli/commands.h"

namespace remote_touch {

// Parses the arguments and runs the command. Returns the exit code; throws InputError for arguments that are
// not understood. choose_kernels is called once, before a command runs.
int run_command_line(int argc, char** argv, CommandLine line, const Kernels& (*choose_kernels)());

}  // namespace remote_touch
