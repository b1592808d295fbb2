// The list of stored baselines: what made each, why it was stored, and how far a number may be from it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/trace/column.h"

namespace remote_touch {

// The reason why numbers were stored, which of them moved from those stored before, and by how much.
struct Revision {
  std::string reason;
  std::string moved;  // "" if nothing had been stored before, or if it was not recorded
};

// A result with which later programs are compared, NAME.h5 beside the manifest.
struct Baseline {
  std::string name;
  std::string command;  // "run" or "sweep"
  std::string subject;  // experiment or sweep: a name of the list, or a JSON file in the same folder
  std::vector<std::string> overrides = {};  // --set
  std::string sha256 = {};                  // hash of NAME.h5
  Revision revision = {};                   // revision of the stored numbers
  std::vector<Revision> history = {};       // all revisions before it, oldest first
  std::vector<std::string> builds = {};  // compilers, levels and threads over which the spread was measured
  // The spread, by column or measure; columns and measures without an entry are exact.
  Tolerances tolerances = {};
};

struct Manifest {
  // Every stored experiment, scenario, fixture rule, trajectory and renderer must have a baseline.
  bool complete = false;
  std::vector<Baseline> baselines = {};

  const Baseline* find(const std::string& name) const;
};

// FOLDER/manifest.json. Throws InputError when it cannot be read or is not as expected.
Manifest read_manifest(const std::filesystem::path& folder);
std::filesystem::path manifest_file(const std::filesystem::path& folder);
std::string text_of(const Manifest& manifest);  // the JSON that read_manifest() reads

std::filesystem::path file_of(const std::filesystem::path& folder, const Baseline& baseline);
// Returns the baseline's subject as the commands expect it: its name, or the path of its JSON file.
std::string subject_of(const std::filesystem::path& folder, const Baseline& baseline);

}  // namespace remote_touch
