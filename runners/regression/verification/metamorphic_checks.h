// Checks of a renderer that need no known answer: each scene is played as it stands and told differently, and
// the two answers must be related as metamorphic_relation.cpp says. Only the renderer's interface is used,
// so whatever is added to the catalog is checked as it is.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"
#include "runners/experiment/factory.h"
#include "runners/regression/verification/output_comparison.h"

namespace remote_touch {

// One check in one scene.
struct CheckResult {
  std::string check;
  std::string meaning;  // one line
  std::string scene;
  std::string reason;  // for the tolerances, one line
  Comparison comparison;
  std::string remark;  // for a failure that may be the scene's and not the renderer's; else empty

  bool passed() const { return comparison.ticks > 0 && comparison.first_violation < 0; }
};

// All results, scene by scene. The first of each scene, "touch", is that the renderer pushes back in most
// ticks, or in some where it lets go by its nature (held by a mesh, or by nothing): without that the others
// would say little. assignments: "r1_m=0.004". Throws InputError for a renderer of six degrees of freedom,
// for an assignment that the renderer refuses, and for a parameter that a change of units cannot follow (see
// dimension.h). stop: when set, ends between two scenes with Interrupted.
std::vector<CheckResult> verify_renderer(const RendererEntry& entry,
                                         const std::vector<std::string>& assignments, const Kernels& kernels,
                                         const std::atomic<bool>* stop = nullptr);

struct CheckName {
  const char* name;
  const char* meaning;
};
// In the order of the results.
std::vector<CheckName> check_names();

}  // namespace remote_touch
