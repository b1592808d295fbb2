// The list of stored baselines, and a stored result with the commands that make it again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_reader.h"
#include "analysis/trace/trace.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/sweep/sweep.h"

namespace remote_touch {

// The list of stored baselines: what made each, why it was stored, and how far a number may be from it.

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

// A stored result, and the commands that make it again with this program.

struct Remaking {
  // Commands for a shell, in this order. Empty if no command of this program makes the result.
  std::vector<std::string> commands;
  // Why there are no commands, or why they are not those that made the result. Empty if they are.
  std::string reason = {};
};

class StoredResult {
 public:
  // Throws InputError for a file that is not a trace, a sweep, a figure or hashes of this program.
  explicit StoredResult(const std::string& file) : StoredResult(Hdf5Reader(file)) {}
  explicit StoredResult(const Hdf5Reader& result);

  const std::string& file() const { return file_; }
  const std::string& kind() const { return kind_; }  // see kind_of()
  const TextAttributes& attributes() const { return attributes_; }
  std::string of(const char* name) const { return attribute(attributes_, name); }
  const std::optional<Recipe>& recipe() const { return recipe_; }

  // The stored configuration with the present names, as JSON.
  std::string config() const;
  // Return the experiment of a trace or of hashes, and the sweep of a sweep, from the stored configuration.
  // Both throw InputError if this program cannot read it.
  Experiment experiment() const;
  Sweep sweep() const;

  // The commands of the recipe, if they still make the stored configuration. Otherwise the commands that make
  // the result from its configuration alone.
  Remaking remaking() const;

 private:
  bool is_known() const;
  bool command_makes_it() const;
  std::vector<std::string> recipe_commands() const;
  Remaking figure_remaking() const;
  Remaking detour() const;
  void add_shard(std::vector<std::string>& words) const;

  std::string file_, kind_;
  TextAttributes attributes_;
  std::optional<Recipe> recipe_;
};

}  // namespace remote_touch
