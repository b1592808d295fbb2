// The kinds of notes on runs. A sweep stores a bit for each kind in place of the notes' texts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/interface/note.h"

namespace remote_touch {

struct NoteKind {
  const char* name;     // Note::kind
  const char* meaning;  // the same for every note of the kind, for counts over many runs
};

// Kind i has bit i of the dataset `notes`. The order is part of the format of sweeps: new kinds are appended.
// Kind 0 stands for all kinds that are not in the list, as scenarios of other programs may have.
const std::vector<NoteKind>& note_kinds();
std::vector<std::string> note_kind_names();

// The bits of the notes' kinds; 0 without notes.
std::int32_t note_bits(const std::vector<Note>& notes);

// "no contact: no point was touched and no force was felt"; the name alone for a kind that is not in the
// list.
std::string text_of_kind(const std::string& name);

}  // namespace remote_touch
