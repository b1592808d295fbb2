#include "entries.h"

#include <analysis/trace/trace.h>
#include <runners/evaluation/verification/metamorphic_checks.h>

#include "centroid_renderer.h"
#include "dome.h"
#include "tap.h"

namespace lab {

namespace {

double mean_force_N(const remote_touch::Trace& trace) {
  double sum = 0;
  for (const remote_touch::Vec3& force_N : trace.force_N) sum += force_N.norm();
  return trace.length() == 0 ? 0 : sum / static_cast<double>(trace.length());
}

}  // namespace

void add_entries(remote_touch::Catalog& catalog) {
  using namespace remote_touch;
  declare_contact_model("centroid", ContactModel::nothing);  // for verify and the contract tests
  catalog.add(renderer_entry<CentroidRenderer>("centroid", DegreesOfFreedom::three,
                                               "a spring away from the centroid of the points near the HIP"));
  catalog.add(scenario_entry<Dome>("dome", "a ball under a flat cloud that rises and sinks"));
  catalog.add(trajectory_entry<Tap>("tap", "taps the scene from above"));
  catalog.add(Measure{"mean_force", "N", "mean magnitude of the force", MeasuredRuns::all, mean_force_N});
}

}  // namespace lab
