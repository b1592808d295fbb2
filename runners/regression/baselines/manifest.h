// The list of stored baselines: what made each, why it is as it is, and how far a number may be from it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/columns/tolerance.h"

namespace remote_touch {

// A result to hold later programs against, NAME.h5 beside the manifest.
struct Baseline {
  std::string name;
  std::string command;  // "run" or "sweep"
  std::string subject;  // what it runs: a name of the list, or a JSON file in the same folder
  std::vector<std::string> overrides = {};  // --set
  std::string sha256 = {};                  // of the file
  std::string reason = {};                  // why it was stored
  std::vector<std::string> builds = {};  // compilers, levels and threads over which the spread was measured
  // The spread, by column or measure: what is not named is exact.
  Tolerances tolerances = {};
};

struct Manifest {
  // Every experiment, scenario, fixture rule, trajectory and renderer of the list has to have a baseline.
  bool complete = false;
  std::vector<Baseline> baselines = {};

  const Baseline* find(const std::string& name) const;
};

// FOLDER/manifest.json. Throws InputError when it cannot be read or written, or is not as expected.
Manifest read_manifest(const std::filesystem::path& folder);
void write_manifest(const std::filesystem::path& folder, const Manifest& manifest);

std::filesystem::path file_of(const std::filesystem::path& folder, const Baseline& baseline);
// What the baseline runs, as the commands take it: its name, or the path of its JSON file.
std::string subject_of(const std::filesystem::path& folder, const Baseline& baseline);

}  // namespace remote_touch
