// Names the program that made a result, if the catalog of that program may have entries that this program
// does not have.
#pragma once

#include <string>

#include "analysis/storage/hdf5_file.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

// Returns "was made by press-lab, ...: expected that program", or a text with the plug-ins that the result
// names. Returns an empty text if this program made the result, or if the result names plug-ins and this
// program has loaded some too, which are not compared.
std::string other_maker(const TextAttributes& result);

// Calls read(), which reads the configuration of a result, and returns its value. If read() throws InputError
// and other_maker() is not empty, throws an InputError with that text instead: the other program has the
// entry that is unknown here.
template <class Read>
auto read_configuration(const TextAttributes& result, const std::string& file, Read&& read) {
  try {
    return read();
  } catch (const InputError&) {
    const std::string maker = other_maker(result);
    if (maker.empty()) throw;
    throw InputError(file, maker);
  }
}

}  // namespace remote_touch
