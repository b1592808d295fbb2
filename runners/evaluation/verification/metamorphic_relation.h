// Relations that must hold for every haptic renderer when its input is transformed. They need no reference
// solution: the renderer's own output for the unchanged scene determines the expected one.
#pragma once

#include <span>

#include "runners/evaluation/verification/output_comparison.h"
#include "runners/evaluation/verification/variation.h"

namespace remote_touch {

struct MetamorphicRelation {
  const char* name;
  const char* meaning;  // one line
  OutputTolerance tolerance;
  const char* reason;            // reason for the tolerance, one line
  bool (*vary)(Variation& run);  // false: does not apply to this scene
};

std::span<const MetamorphicRelation> metamorphic_relations();
// Relations for a renderer of a tool, with tolerances of their own.
std::span<const MetamorphicRelation> tool_relations();

}  // namespace remote_touch
