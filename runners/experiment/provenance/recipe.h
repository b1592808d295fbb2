// The recipe of a result, as fields, with which a program can make it again.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"

namespace remote_touch {

struct Recipe {
  std::string action;   // run, sweep, replay, figure or compare
  std::string subject;  // subject of the action; the sweep of a replay, the baseline of a comparison
  std::vector<std::string> overrides = {};  // key=value
  std::vector<std::size_t> cell = {};       // cell of a replay: index on each axis
  int replicate = 0;                        // replicate of a replay
  int coarse = 1;                           // --coarse of a figure; 1: all values of each axis
  std::string candidate = {};               // candidate of a comparison
  std::vector<std::string> tolerances = {};
};

// Returns the words of each command, without output, threads and shard. A replay has two commands: the
// command of its sweep and its own.
std::vector<std::vector<std::string>> commands(const Recipe& recipe);
// The same as text for a shell, "; " between the commands.
std::string command_text(const Recipe& recipe);

// The attribute of the result that holds its recipe as JSON.
inline constexpr const char* kRecipe = "recipe";
std::string to_json(const Recipe& recipe);
// Returns nothing if the result has no recipe, or one that this program cannot read.
std::optional<Recipe> recipe_of(const TextAttributes& attributes);

}  // namespace remote_touch
