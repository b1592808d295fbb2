// Parameters from and to JSON, with the checks that every configuration shares.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <typeinfo>
#include <utility>
#include <vector>

#include "core/parameters/parameter.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {

// An error in the text of a file, such as an experiment. It begins with the name of that file.
class FileRefusal : public InputError {
 public:
  using InputError::InputError;
};

// Returns the line without its subject if that is `subject`; otherwise the whole line.
std::string without_subject(const std::string& subject, const std::string& line);

// Returns read(overrides), which reads the text of the file with overrides "key=value" on top of it. If
// read() throws InputError because the text is wrong, the message begins with the name of the file. The text
// is wrong if read() refuses it in the same words without overrides. A class of its own derived from
// InputError, such as that of a problem in Python, passes unchanged.
template <class Read>
auto with_file_in_refusal(const std::string& file, const std::vector<std::string>& overrides, Read&& read) {
  const auto line_of = [&](const InputError& error) { return without_subject(file, error.what()); };
  const auto is_refused_alone = [&](const std::string& line) {
    try {
      read(std::vector<std::string>());
      return false;
    } catch (const InputError& alone) {
      return line_of(alone) == line;
    }
  };
  try {
    return read(overrides);
  } catch (const InputError& error) {
    if (typeid(error) != typeid(InputError)) throw;
    const std::string line = line_of(error);
    if (overrides.empty() || is_refused_alone(line)) throw FileRefusal(file, line);
    throw InputError(line);
  }
}

// Sets every parameter that the object names. Throws InputError for an unknown key (with the nearest known
// one), a value of the wrong kind or one out of range; path is the name of the object, for example
// "renderer". elsewhere: keys that the caller reads itself.
void read_parameters(const Json& object, const Parameters& parameters, const std::string& path,
                     const std::vector<std::string>& elsewhere = {});

// Throws InputError for a key that is none of the known ones: "PREFIXKEY: unknown; did you mean
// PREFIXNEAREST".
[[noreturn]] void refuse_key(const std::string& key, const std::vector<std::string>& known,
                             const std::string& prefix);

// Returns the known key with the most similar spelling, if at most a third of the letters differ; else an
// empty text.
std::string similar_key(const std::string& key, const std::vector<std::string>& known);

// Writes all parameters with their present values, in the order of the list.
void write_parameters(const Parameters& parameters, Json& object);

// The range of a parameter, and its present value, as text for help.
std::string allowed(const Parameter& parameter);
std::string value_text(const Parameter& parameter);

// Returns the keys of a path like "renderer.r1_m" or "axes.0.count": names of members, and indices in lists.
std::vector<std::string> path_keys(const std::string& path);

// True for a key that is an index in a list: "0", "12".
bool is_index(const std::string& key);

// Returns the value to which the keys lead; null if there is none.
const Json* find_value(const Json& json, std::span<const std::string> keys);

// Sets the value at a path like "renderer.r1_m" or "axes.0.count"; creates missing objects on the path.
// Throws InputError, about the subject, if the path leads through a value or past the end of a list.
void set_value(Json& configuration, const std::string& path, const Json& value, const std::string& subject);

// Returns the path and the value of an assignment such as "renderer.r1_m=0.004". The value is read as JSON,
// or as a number such as .3 and 3.; otherwise it is plain text. Throws InputError.
std::pair<std::string, Json> read_assignment(const std::string& assignment);

// Sets the value of such an assignment in a configuration.
void apply_override(Json& configuration, const std::string& assignment);

}  // namespace remote_touch
