// The folder of a scorecard: its runs, traces of failures, and results.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runners/evaluation/scorecard/benchmark_plan.h"
#include "runners/evaluation/scorecard/evaluation.h"

namespace remote_touch {

inline constexpr const char* kScorecardFile = "scorecard.h5";

// Makes the folder with its subfolders. Throws InputError.
void make_scorecard_folder(const std::string& folder);

// Throws InputError unless the plan has every method and scene of the scorecard in that file, because results
// are replaced. Does nothing if the file does not exist.
void require_all_of(const std::filesystem::path& file, const BenchmarkPlan& plan);

// Returns the command that makes a scorecard of these.
std::string scorecard_command(const std::vector<std::string>& methods, const std::vector<std::string>& scenes,
                              int seeds);

// Writes the HDF5 file and the JSON file of the scorecard. Returns the digest.
std::string write_scorecard(const std::filesystem::path& folder, const BenchmarkPlan& plan,
                            const ScorecardReport& report, const std::string& command);

}  // namespace remote_touch
