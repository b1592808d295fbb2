// The kinds of the notes of a run, a hand or a recording.
#pragma once

#include <string>
#include <vector>

#include "scenarios/simulated/scenario.h"

namespace remote_touch {

using Kinds = std::vector<std::string>;

inline Kinds kinds_of(const std::vector<Note>& notes) {
  Kinds kinds;
  for (const Note& note : notes) kinds.push_back(note.kind);
  return kinds;
}

}  // namespace remote_touch
