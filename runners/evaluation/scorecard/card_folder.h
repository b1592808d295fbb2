// The folder of a scorecard: its runs, traces of failures, and results.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "runners/evaluation/scorecard/benchmark.h"
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

// A scorecard's numbers in a small sealed file of data/, with which a later card is compared.

inline constexpr const char* kStoredCardFigure = "stored-scorecard";

struct StoredCard {
  std::string configuration;  // methods and scenes as JSON, see configuration()
  int replicates = 0;
  std::vector<std::string> methods, scenes;  // names in it
  CardNumbers numbers;
};

// Returns the digest. provenance: config must be the card's configuration().
std::string write_stored_card(const std::filesystem::path& file, const Scorecard& card,
                              const TextAttributes& provenance);
// Throws InputError if the file is not a stored card.
StoredCard read_stored_card(const std::filesystem::path& file);

// Returns the results of the stored card as Markdown: first those in which the project's own method is not
// the best, then all methods, with the runs below each threshold of perception. Throws InputError
// if the file is not a stored card.
std::string stored_summary(const std::filesystem::path& file);

// Returns a sentence for each method and scene of the plan that is not in the stored card, or is defined in
// another way there, and for each number that does not agree, see differences() of numbers. plan: without
// scenes that were skipped.
std::vector<std::string> differences(const StoredCard& stored, const BenchmarkPlan& plan,
                                     const Scorecard& now);

// Returns the configuration() of the parts that a plan runs: without scenes whose recording is not on this
// machine.
std::string configuration_of(const BenchmarkPlan& plan);

// scorecard.json: the data from which scripts/plot makes the page of a scorecard. It contains all decisions
// (which method is marked, which words a verdict has); a page only formats them.

inline constexpr const char* kScorecardSchema = "remote-touch-scorecard/5";

// SI units, null for a number that is missing. The lists "methods" and "laws" have the same order everywhere.
std::string to_json(const ScorecardReport& report);

}  // namespace remote_touch
