// Errors of the points and normals that settings of the depth pipeline make of a recording, over all pixels
// that show a true object: against the true surface, and against the measured one.
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/trace/interval_estimates.h"
#include "core/dissertation/depth/depth_pipeline.h"
#include "core/kernels/kernels.h"
#include "scenarios/recordings/recorded_scene.h"

namespace remote_touch {

// Over the pixels in which every setting has a point with a distance to both surfaces. NaN if there are none.
struct DepthErrors {
  double pixels = 0;
  double to_measured_m = kNoValue;  // rms distance of the points to the measured surface
  double to_true_m = kNoValue;      // rms distance to the true surface
  double true_mean_m = kNoValue;    // mean signed distance to it, positive outside
  double to_true_90_m = kNoValue;   // 90 % of the points are nearer to the true surface than this
  double normal_deg = kNoValue;     // median angle between the normal and the true one
};

// The pixels that are compared: of the first frames, every n-th one, and in it every n-th row and column.
struct DepthSample {
  int frames = 1;
  int frame_step = 10;
  int pixel_step = 3;
};

// Returns errors[object][setting] for the listed objects of RecordedTruth::objects(). A pixel belongs to the
// object that the camera would see there without errors, and is used if its measured depth is within 30 mm of
// the true one. Pre: scene.truth() is not null, the frames are images, the playback ends.
std::vector<std::vector<DepthErrors>> depth_errors(const RecordedScene& scene,
                                                   const std::vector<std::size_t>& objects,
                                                   const std::vector<DepthPipelineSettings>& settings,
                                                   const DepthSample& sample, const Kernels& kernels);

}  // namespace remote_touch
