// Refuses a run whose frames lack what its renderer, fixture rules or guidance need. The message is one line
// that says what to add. check_needs() checks the first frame before the run starts. RendererNeeds checks
// every frame, because the frames of a recording may differ.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_assignment.h"
#include "core/rendering/frame.h"
#include "runners/experiment/sessions/sensor_frame.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

struct ExperimentConfiguration;

// The needs of one renderer. A renderer without needs accepts every frame.
class RendererNeeds {
 public:
  RendererNeeds() = default;
  RendererNeeds(std::string renderer, std::vector<FrameNeed> needs)
      : renderer_(std::move(renderer)), needs_(std::move(needs)) {}
  // Throws InputError for a frame whose points have no normals or are unorganised, if the renderer needs
  // normals or organised points. A frame without points is accepted. If normals are needed, at least one of
  // the measured points of frame 0 must have one.
  void check(const Frame& frame) const;

 private:
  std::string renderer_;
  std::vector<FrameNeed> needs_;
};

// Returns the needs that the catalog lists for the renderer.
std::vector<FrameNeed> renderer_needs(const ExperimentConfiguration& configuration);

// Checks the first frame of the scenario before a run. Throws InputError. fixtures: the fixtures of the
// configuration.
void check_needs(const ExperimentConfiguration& configuration, const FixtureAssignment& fixtures,
                 const Scenario& scenario);
// Checks the renderer's needs against what a live sensor reports before its first frame. Throws InputError.
void check_needs(const ExperimentConfiguration& configuration, const SensorView& view);

}  // namespace remote_touch
