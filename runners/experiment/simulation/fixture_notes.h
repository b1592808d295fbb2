// Notes on fixture rules without an effect.
#pragma once

#include <memory>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_assignment.h"
#include "scenarios/interface/note.h"

namespace remote_touch {

class NeighbourSearch;

// Returns a note "nothing selected" for each rule that selects no point of the first frame and none of the
// last, whatever its schedule. first, last: null if no frame arrived. Returns no notes if the points of one
// of these frames are not stored.
std::vector<Note> fixture_notes(const FixtureAssignment& fixtures,
                                const std::shared_ptr<const NeighbourSearch>& first,
                                const std::shared_ptr<const NeighbourSearch>& last);

}  // namespace remote_touch
