// The availability of a device, as `remote-touch devices` prints it.
#pragma once

#include <string>

#include "core/parameters/input_error.h"

namespace remote_touch {

struct Availability {
  bool compiled_in = true;
  bool found = false;  // a device that can be opened is present now
  std::string detail;  // the device found, or the reason why there is none and what would help; one line
  bool was_searched = true;  // false: only opening tells whether there is a device; found is then false
};

inline Availability always(const char* what) {
  return {true, true, what};
}

// Returns what look() finds, or the reason if it throws InputError.
template <class Look>
Availability availability_of(Look look) {
  try {
    return look();
  } catch (const InputError& error) {
    return {.detail = error.what()};
  }
}

}  // namespace remote_touch
