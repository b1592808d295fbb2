// Metamorphic tests of a renderer, which need no reference solution: each scene is played unchanged and
// transformed, and the two outputs must be related as metamorphic_relation.cpp defines. They use only the
// interface Renderer, so every new renderer of the catalog is checked without further work.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"
#include "runners/evaluation/verification/verification_scenes.h"
#include "runners/experiment/catalog/factory.h"

namespace remote_touch {

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

// One check in one scene.
struct CheckResult {
  std::string check;
  std::string meaning;  // one line
  std::string scene;
  std::string reason;  // reason for the tolerances, one line
  Comparison comparison;
  std::string remark;  // set for a failure that the scene may cause and not the renderer; else empty

  bool passed() const { return comparison.ticks > 0 && comparison.first_violation < 0; }
};

// Returns all results, scene by scene. The first result of each scene, "touch", checks that the renderer
// exerts a force in most ticks, or in some ticks if its contact model may lose contact. Without it the other
// checks would mean little. assignments: "r1_m=0.004"; a renderer of a tool has kVerifiedTool unless they
// name another. Throws InputError for an assignment that the renderer refuses, and for a parameter whose
// units cannot be changed (see variation.h). stop: when set, ends between two scenes with Interrupted.
// Without scenes: verification_scenes(), or tool_scenes() for a renderer of six degrees of freedom.
std::vector<CheckResult> verify_renderer(const RendererEntry& entry,
                                         const std::vector<std::string>& assignments, const Kernels& kernels,
                                         const std::atomic<bool>* stop = nullptr);
std::vector<CheckResult> verify_renderer(const RendererEntry& entry,
                                         const std::vector<std::string>& assignments, const Kernels& kernels,
                                         const std::vector<MetamorphicScene>& scenes,
                                         const std::atomic<bool>* stop = nullptr);

struct CheckName {
  const char* name;
  const char* meaning;
};
// Returns the checks in the order of the results.
std::vector<CheckName> check_names(DegreesOfFreedom degrees_of_freedom = DegreesOfFreedom::three);

}  // namespace remote_touch
