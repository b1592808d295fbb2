// A stored result, and the commands that make it again with this program.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_reader.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/sweep/sweep.h"

namespace remote_touch {

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
