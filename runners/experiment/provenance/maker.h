// The program that made a result, where its catalog may have entries that this program's has not.
#pragma once

#include <string>

#include "analysis/storage/hdf5_file.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

// "was made by press-lab, ...: expected that program", or the plug-ins that the result names. Empty if this
// program made it, or one with the same plug-ins.
std::string other_maker(const TextAttributes& result);

// Calls read(), which reads the configuration of a result, and returns its value. If it throws InputError and
// another program made the result, the error names that program instead of the entry that is unknown here.
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
