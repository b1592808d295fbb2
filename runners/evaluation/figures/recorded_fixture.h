// Checks of a run against its recording, frame by frame: where the proxy is relative to the measured points,
// and how the surface moved. Computed from every point, not with the renderer's kernels.
#pragma once

#include <vector>

#include "runners/evaluation/figures/fixture_run.h"

namespace remote_touch {

// Outcome of a frame, in the last tick before the next frame arrived.
struct FrameOutcome {
  std::size_t tick = 0;
  double nearest_distance_m = 0;  // distance of the proxy to the nearest measured point
  double hidden_m = 0;            // depth of the proxy behind that of its own pixel; NaN at a hole
  double camera_motion_m = 0;     // median over the image: how far a pixel's point moved since the last frame
  double surface_motion_m = 0;    // around the pixel that the HIP presses: towards the camera, likewise
};

// pre: the experiment plays a part of a recording forwards and backwards (ping_pong), and every frame
// arrives.
std::vector<FrameOutcome> frame_outcomes(const Experiment& experiment, const FixtureRun& run);

// A tick in which the proxy changed to the wrong side of the true surface.
struct PopThrough {
  std::size_t tick = 0;
  double surface_motion_m =
      0;  // past the proxy, from the frame before to this one, by the planes through both
};
std::vector<PopThrough> pop_throughs(const FixtureRun& run);

}  // namespace remote_touch
