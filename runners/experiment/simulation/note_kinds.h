// The kinds of notes on runs. A sweep stores one bit for each kind instead of the texts of the notes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/interface/note.h"

namespace remote_touch {

struct NoteKind {
  const char* name;     // Note::kind
  const char* meaning;  // a text for counts over many runs, the same for every note of the kind
};

// Kind i has bit i of the dataset `notes`. The order is part of the file format of sweeps, so new kinds are
// appended, at most 64. Kind 0 includes all kinds that are not in the list, for example from scenarios of
// other programs.
const std::vector<NoteKind>& note_kinds();
std::vector<std::string> note_kind_names();

// Returns the bits of the kinds of these notes; 0 without notes.
std::uint64_t note_bits(const std::vector<Note>& notes);

// Returns name and meaning, such as "no contact: no point was touched and no force was felt". Returns the
// name alone for a kind that is not in the list.
std::string text_of_kind(const std::string& name);

}  // namespace remote_touch
