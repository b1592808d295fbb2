// Refuses a run whose frames lack what its renderer, fixture rules or guidance need: in one line that says
// what to add, before the run starts; and in a recording whose frames differ, at the first frame that lacks
// it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/dissertation/virtual_fixtures/fixture_assignment.h"
#include "core/rendering/frame.h"
#include "core/rendering/frame_need.h"
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
  // Throws InputError for a frame whose points have no normals or are unorganised, if that is needed. A frame
  // without points lacks nothing. Of frame 0, one of the measured points must have a normal.
  void check(const Frame& frame) const;

 private:
  std::string renderer_;
  std::vector<FrameNeed> needs_;
};

// The needs in the catalog's line of the renderer.
std::vector<FrameNeed> renderer_needs(const ExperimentConfiguration& configuration);

// Before a run. Each throws InputError. fixtures: those of the configuration.
void check_needs(const ExperimentConfiguration& configuration, const FixtureAssignment& fixtures,
                 const Scenario& scenario);
// Checks the renderer's needs against what a live sensor reports before its first frame.
void check_needs(const ExperimentConfiguration& configuration, const SensorView& view);

}  // namespace remote_touch
