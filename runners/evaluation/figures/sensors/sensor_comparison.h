// Simulated depth sensors against recordings of real ones: both see the same scenes, and both are measured by
// image_measures.h.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "analysis/measures/image_measures.h"
#include "core/kernels/kernels.h"
#include "runners/evaluation/figures/sensors/simulated_sensor.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

// A model, and the recording of a sensor of its kind.
struct ComparedSensor {
  DepthSensorKind kind = DepthSensorKind::simple;
  std::string recording;                   // its path, for messages
  int frames = 1;                          // number of frames that are compared, from the first one on
  bool is_at_rest = false;                 // camera and scene are, in these frames
  double step_near_m = 0, step_far_m = 0;  // the steps of depth are larger than the unit of depth here
};

struct SourceStatistics {
  std::vector<DepthImage> frames;
  std::vector<DepthNoise> over_time;     // empty: the scene is not at rest
  std::vector<DepthNoise> about_planes;  // windows of 20 x 20 pixels
  std::vector<DepthEdge> edges;          // edges with a jump of 0.1 per m or more
};

struct SensorComparison {
  double focal_px = 0;  // value of the recorded images
  double own_focal_px =
      0;  // value of the sensor's own images, if its steps of disparity have the published size
  double baseline_m = 0;  // published
  SourceStatistics recorded;
  SourceStatistics simulated;  // published numbers and the focal length of the recorded images
  SourceStatistics own_focal;  // see with_own_focal_length()
};

// The simulated sensors see the recorded scene with filled holes, and for noise about planes the planes that
// were fitted to it. If the scene is at rest, it is that of the first frame. Throws InputError if the
// recording cannot be read or its frames are not images.
SensorComparison compare_sensor(const Scenario& scene, const ComparedSensor& sensor, const Kernels& kernels);

// Errors of depth on a true object in one frame; NaN if it shows no pixel. measured: share of the pixels that
// show the object in truth and have a depth.
struct ObjectErrors {
  double measured = kNoValue, median_m = kNoValue, spread_m = kNoValue;
};
struct FrameErrors {
  int frame = 0;
  std::vector<ObjectErrors> recorded, simulated;  // one for each object of RecordedTruth::objects()
};
struct TrueObjectErrors {
  std::vector<std::string> objects;
  std::vector<FrameErrors> frames;
};
// Returns the errors in every frame_step-th frame of the recording, of the sensor and of the model with
// published numbers. Throws InputError also if the recording has no true objects.
TrueObjectErrors true_object_errors(const Scenario& scene, const ComparedSensor& sensor, int frame_step,
                                    const Kernels& kernels);

}  // namespace remote_touch
