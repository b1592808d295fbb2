// Names the program that made a result, if the catalog of that program may have entries that this program
// does not have.
#pragma once

#include <string>

#include "analysis/storage/hdf5_file.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

// Returns "was made by press-lab, ...: expected that program", or a text with the plug-ins that the result
// names. Returns an empty text if this program made the result and has loaded all these plug-ins. Plug-ins
// are the same if their SHA-256 is.
std::string other_maker(const TextAttributes& result);

// Calls read(), which reads the configuration of a result, and returns its value. If read() throws InputError
// and other_maker() is not empty, throws an InputError that begins with that text, because the other program
// may have an entry that is unknown here.
template <class Read>
auto read_configuration(const TextAttributes& result, const std::string& file, Read&& read) {
  try {
    return read();
  } catch (const InputError& error) {
    const std::string maker = other_maker(result);
    if (maker.empty()) throw;
    throw InputError(file, maker + " (here: " + error.what() + ")");
  }
}

}  // namespace remote_touch
