// What must stay true of every haptic renderer when its input is told differently. No answer needs to be
// known for that: the renderer's own answer to the scene as it stands tells what the other must be.
#pragma once

#include <span>

#include "runners/regression/verification/output_comparison.h"
#include "runners/regression/verification/variation.h"

namespace remote_touch {

struct MetamorphicRelation {
  const char* name;
  const char* meaning;  // one line
  OutputTolerance tolerance;
  const char* reason;            // for the tolerance, one line
  bool (*vary)(Variation& run);  // false: there is nothing to vary in this scene
};

std::span<const MetamorphicRelation> metamorphic_relations();

}  // namespace remote_touch
