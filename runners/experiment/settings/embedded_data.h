// The JSON files of data/, compiled into the program.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace remote_touch {

struct EmbeddedText {
  const char* name;
  const char* json;
};

std::span<const EmbeddedText> embedded_experiments();
std::span<const EmbeddedText> embedded_sweeps();
// The renderers of the scorecard with their settings, and its scenes.
std::span<const EmbeddedText> embedded_methods();
std::span<const EmbeddedText> embedded_scenes();
// Numbers of tests/second_implementation, by chapter.
std::span<const EmbeddedText> embedded_second_implementation();

// True if one of the texts has this name.
bool is_stored(std::span<const EmbeddedText> stored, const std::string& name);

// Returns the stored text of that name, or the text of that file. Throws InputError if there is neither.
// kind: words for its message, such as "an experiment's".
std::string embedded_or_file(std::span<const EmbeddedText> stored, const std::string& name_or_file,
                             const std::string& kind);

// Numbers that the second implementation (tests/second_implementation) computes from the equations, for
// claims to compare with. Its tables are data/second_implementation/*.json, so no number is copied by hand.

// Returns a number by the name of the table and its path in it: ("chapter_5", "/crossing/max_force_N").
double second_number(const std::string& table, const std::string& place);
// Returns the same column of every row of a list.
std::vector<double> second_column(const std::string& table, const std::string& list,
                                  const std::string& column);

}  // namespace remote_touch
