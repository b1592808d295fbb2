// The folder of a scorecard: its runs, traces of failures, and results.
#pragma once

#include <filesystem>
#include <string>

#include "runners/evaluation/scorecard/benchmark_plan.h"

namespace remote_touch {

inline constexpr const char* kScorecardFile = "scorecard.h5";

// Makes the folder with its subfolders. Throws InputError.
void make_scorecard_folder(const std::string& folder);

// Throws InputError unless the plan has every method and scene of the scorecard in that file, because results
// are replaced. Does nothing if the file does not exist.
void require_all_of(const std::filesystem::path& file, const BenchmarkPlan& plan);

}  // namespace remote_touch
