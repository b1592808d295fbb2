// What can be typed: options, help, and which command they lead to.
#pragma once

#include "core/kernels/kernels.h"
#include "runners/cli/commands.h"

namespace remote_touch {

// Reads the arguments and does what they ask for. Returns the exit code; throws InputError for what cannot be
// understood. choose_kernels is asked once, when a command is to run.
int run_command_line(int argc, char** argv, CommandLine line, const Kernels& (*choose_kernels)());

}  // namespace remote_touch
