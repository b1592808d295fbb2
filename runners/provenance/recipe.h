// How a result was made, as fields, so that a program can make it again.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"

namespace remote_touch {

struct Recipe {
  std::string action;   // run, sweep, replay, figure or compare
  std::string subject;  // of the action; for a replay its sweep, for a comparison the baseline
  std::vector<std::string> overrides = {};  // key=value
  std::vector<std::size_t> cell = {};       // of a replay: index on each axis
  int replicate = 0;                        // of a replay
  int coarse = 1;                           // of a figure
  std::string candidate = {};               // of a comparison
  std::vector<std::string> tolerances = {};
};

// The words of the command without output, threads and shard; for a replay those of its sweep, then its own.
std::vector<std::vector<std::string>> commands(const Recipe& recipe);
// The same as text for a shell, "; " between the commands.
std::string command_text(const Recipe& recipe);

// As an attribute of the result.
inline constexpr const char* kRecipe = "recipe";
std::string to_json(const Recipe& recipe);
// None if the result has none, or a recipe that this program did not write.
std::optional<Recipe> recipe_of(const TextAttributes& attributes);

}  // namespace remote_touch
