// The folder of a scorecard: its runs, traces of failures, and results.
#pragma once

#include <filesystem>
#include <string>

#include "runners/scorecard/benchmark_plan.h"

namespace remote_touch {

inline constexpr const char* kScorecardFile = "scorecard.h5";

// Makes the folder with its subfolders. Throws InputError.
void make_scorecard_folder(const std::string& folder);

// What the scorecard in that file has, if there is one, the plan must have too: results are replaced. Throws
// InputError.
void require_all_of(const std::filesystem::path& file, const BenchmarkPlan& plan);

}  // namespace remote_touch
