// Relations that must hold for every haptic renderer when its input is transformed. They need no reference
// solution: the renderer's own output for the unchanged scene determines the expected one.
#pragma once

#include <vector>

#include "core/rendering/renderer.h"
#include "runners/evaluation/verification/variation.h"

namespace remote_touch {

// Allowed differences between two runs. 0 everywhere: equal bits, except for the sign of a zero.
struct OutputTolerance {
  double position_m = 0;
  double force_fraction = 0;  // fraction of the largest force in the run
  double velocity_m_per_s = 0;
  double normal = 0;
  bool rounded = false;        // true: steps are not compared, and normals only while a point is touched
  double rotation_rad = 0;     // rotation of a tool
  double torque_fraction = 0;  // fraction of the largest torque in the run
  // true: the nearest distance, the normal and "other" are not compared; the depth in a tool still is.
  bool without_contact_details = false;
};

struct MetamorphicRelation {
  const char* name;
  const char* meaning;  // one line
  OutputTolerance tolerance;
  const char* reason;            // reason for the tolerance, one line
  bool (*vary)(Variation& run);  // false: does not apply to this scene
};

// A renderer of six degrees of freedom, of a tool, has relations and tolerances of its own.
std::vector<MetamorphicRelation> relations_of(DegreesOfFreedom degrees_of_freedom);

}  // namespace remote_touch
