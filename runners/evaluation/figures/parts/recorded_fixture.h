// Checks a run against its recording, frame by frame: the position of the proxy relative to the measured
// points, and the motion of the surface. They are computed from every point, not with the renderer's kernels.
#pragma once

#include <vector>

#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/trace.h"
#include "runners/experiment/catalog/experiment.h"

namespace remote_touch {

// Outcome of a frame, in the last tick before the next frame arrived.
struct FrameOutcome {
  std::size_t tick = 0;
  double nearest_distance_m = kNoValue;  // distance of the proxy to the nearest measured point; NaN: none
  double hidden_m = kNoValue;            // depth of the proxy behind that of its own pixel; NaN at a hole
  // Motion of a pixel's point since the last frame, median over the image, and the same towards the camera,
  // around the pixel that the HIP presses. NaN if unknown.
  double camera_motion_m = kNoValue, surface_motion_m = kNoValue;
};

// The first frame has no frame before it: its motions are NaN. pre: the experiment plays a part of a
// recording forwards and backwards (ping-pong), and every frame arrives.
std::vector<FrameOutcome> frame_outcomes(const Experiment& experiment, const Trace& trace,
                                         const Scenario& scenario);

// A tick in which the proxy changed to the wrong side of the true surface.
struct PopThrough {
  std::size_t tick = 0;
  double surface_motion_m =
      0;  // past the proxy since the frame before, by the planes of both; NaN if unknown
};
std::vector<PopThrough> pop_throughs(const Trace& trace, const Scenario& scenario);

}  // namespace remote_touch
