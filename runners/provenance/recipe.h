// What made a result, as fields, for a program that makes it again.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"

namespace remote_touch {

struct Recipe {
  std::string action;   // run, sweep, replay, figure or compare
  std::string subject;  // of the action; of a replay its sweep, of a comparison the baseline
  std::vector<std::string> overrides = {};  // key=value
  std::vector<std::size_t> cell = {};       // of a replay: its place on each axis
  int replicate = 0;                        // of a replay
  int coarse = 1;                           // of a figure
  std::string candidate = {};               // of a comparison
  std::vector<std::string> tolerances = {};
};

// The words of the command without output, threads and shard; of a replay those of its sweep, and then its
// own.
std::vector<std::vector<std::string>> commands(const Recipe& recipe);
// The same for a shell, "; " between them.
std::string command_text(const Recipe& recipe);

// As an attribute of the result.
inline constexpr const char* kRecipe = "recipe";
std::string to_json(const Recipe& recipe);
// None where the result has none, or one that no program wrote.
std::optional<Recipe> recipe_of(const TextAttributes& attributes);

}  // namespace remote_touch
