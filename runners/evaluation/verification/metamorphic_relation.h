// Relations that must hold for every haptic renderer when its input is transformed. They need no reference
// solution: the renderer's own output for the unchanged scene determines the expected one.
#pragma once

#include <span>
#include <vector>

#include "core/rendering/renderer.h"
#include "runners/evaluation/verification/variation.h"

namespace remote_touch {

// Compares the outputs of a run with the expected ones, tick by tick.

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

// The largest difference of one kind.
struct Deviation {
  // "position" (proxy, slave, frame correction), "nearest" (nearest distance, and penetration of a tool),
  // "force", "velocity", "normal", "rotation" and "torque" of a tool, or "other": 1 if state, convergence,
  // steps, counts, frame or status differ.
  const char* quantity;
  const char* unit;
  double tolerance = 0;
  double max = 0;  // infinite if only one of the two is a finite number
};

struct Comparison {
  std::vector<Deviation> deviations;
  int first_violation = -1;  // the tick; -1: none
  int ticks = 0;             // number of ticks that were compared
};

// pre: as many outputs as expected. until_velocity: ends as soon as either run has estimated a surface
// velocity.
Comparison compare(const std::vector<RenderOutput>& expected, const std::vector<RenderOutput>& outputs,
                   const OutputTolerance& tolerance, bool until_velocity);

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
