// Makes a stored result again.
#pragma once

#include <string>

#include "runners/evaluation/regression/result_comparison.h"
#include "runners/interfaces/cli/program.h"

namespace remote_touch {

// Runs a trace, a sweep, hashes or a figure again from the configuration that it has stored, and compares
// every number. Throws InputError for another kind of file, and as the runs themselves do.
ResultComparison made_again(const CommandLine& line, const std::string& file);

}  // namespace remote_touch
