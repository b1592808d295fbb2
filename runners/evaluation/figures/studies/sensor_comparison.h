// Simulated depth sensors against recordings of real ones: both see the same scenes, and both are measured by
// image_measures.h.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "analysis/trace/image_measures.h"
#include "analysis/trace/trace.h"
#include "core/kernels/kernels.h"
#include "core/points/noise.h"
#include "core/points/point_cloud.h"
#include "scenarios/objects/mesh_scene.h"
#include "scenarios/objects/recorded_truth.h"
#include "scenarios/scene/scenario.h"
#include "scenarios/simulated/depth_sensor.h"

namespace remote_touch {

// A simulated depth sensor before a scene that a real one has recorded.

// A scene as the depths of its surfaces, and the cosine of the angle between each pixel's ray and its
// surface's normal; without cosines all surfaces count as seen head-on.
struct DepthScene {
  DepthImage depth;
  std::vector<double> cosine = {};
};

// Returns the recorded scene with a depth also in the holes of the image. A hole gets the farther one of the
// depths that end it on the left and on the right in its row, because shadows of a sensor lie on far
// surfaces. Holes at the border of the image remain.
DepthScene filled_scene(const DepthImage& recorded);

// Returns the planes that were fitted to windows of an image. There is nothing where no plane was fitted.
DepthScene planar_scene(std::span<const FittedWindow> windows, const CameraIntrinsics& camera);

// Returns the settings of a sensor with the width, the height and the focal length (that along the rows) of
// the camera, and with published numbers for everything else.
DepthSensorSettings sensor_settings(DepthSensorKind kind, const CameraIntrinsics& camera);

// Returns settings for images that show focal / own_focal as many pixels as the sensor's own images. In such
// images its noise, its steps and its matching window, in pixels of disparity, grow by that factor. The
// shadow does not change.
DepthSensorSettings with_own_focal_length(DepthSensorSettings settings, double own_focal_px);

// Returns so many frames of the scene, which is at rest.
std::vector<DepthImage> simulated_frames(const DepthSensorSettings& settings, const DepthScene& scene,
                                         int count, const Kernels& kernels);

// Depths of the true objects in a frame, as their meshes and poses state it, and as a sensor measures them.
struct ObjectImage {
  DepthImage true_depth, measured;
  std::vector<int> object;  // the object that each pixel shows; -1: none
};
// Returns what a recorded frame shows of the true objects. camera: that of the recording.
ObjectImage recorded_objects(const RecordedTruth& truth, std::size_t frame, const DepthImage& recorded,
                             const CameraIntrinsics& camera);
// Returns what the scenario mesh-scene shows of the true objects at the poses of a frame, with nothing behind
// them.
ObjectImage simulated_objects(const RecordedTruth& truth, std::size_t frame,
                              const DepthSensorSettings& settings, const Kernels& kernels);

// Depth minus true depth of the pixels of an object, in m. Left out are pixels that are less than 3 pixels
// from another object in their row or column, and errors of 50 mm or more, which are those of other surfaces.
std::vector<double> depth_errors_of(const ObjectImage& image, int object);

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

// The tables of a comparison of simulated depth sensors with a real one.

// The look of a comparison. The name is a part of the names of tables, and jumps are those of 1 / z.
struct ShownSensor {
  std::string name, title;
  ComparedSensor compared;
  std::vector<double> bounds_m;                        // bounds of the ranges of distance
  double last_jump_per_m;                              // beyond it there are few edges
  double edge_low_per_m = 0.4, edge_high_per_m = 0.7;  // jumps of the edges in the table of holes
};

// The recorded sensor or one of the simulated ones, with its names in columns and legends.
struct SensorSource {
  const char *column, *label;
  SourceStatistics SensorComparison::*statistics;
};
inline constexpr SensorSource kRecordedSensor{"recorded", "recorded", &SensorComparison::recorded};
inline constexpr SensorSource kSimulatedSensor{"simulated", "simulated", &SensorComparison::simulated};
inline constexpr SensorSource kOwnFocalSensor{"own_focal", "simulated, own focal length",
                                              &SensorComparison::own_focal};
inline constexpr const SensorSource* kSensorSources[] = {&kRecordedSensor, &kSimulatedSensor,
                                                         &kOwnFocalSensor};

// A sensor and what was measured of it. A range is that between two of the bounds.
struct MeasuredSensor {
  ShownSensor shown;
  SensorComparison comparison;

  std::size_t ranges() const { return shown.bounds_m.size() - 1; }
  std::string table(const char* what) const { return std::string(what) + "_" + shown.name; }
  // Standard deviation of a pixel's depth over time which that share of the pixels does not exceed.
  double over_time_m(const SensorSource& source, std::size_t range, double share = 0.5) const;
  // rms about the plane of a window: the lower quartile over the windows. Windows on curved surfaces have
  // larger residuals than noise alone.
  DepthNoise about_planes(const SensorSource& source, std::size_t range) const;
  double about_planes_m(const SensorSource& source, std::size_t range) const {
    return about_planes(source, range).in_m();
  }
  // The edges of the table of holes.
  std::vector<DepthEdge> shown_edges(const SensorSource& source, bool is_left_of_near) const;
};

// Returns "left" or "right", of near surfaces.
std::string side_name(bool is_left_of_near);
inline constexpr bool kEdgeSides[] = {true, false};

inline constexpr double kLoudShare = 0.9;  // number of the pixels whose noise over time is in the tables

// Table `noise_NAME` over the ranges of distance: noise over time (`time_SOURCE`, and its 90 % quantile
// `loud_SOURCE`) if the scene is at rest, `planes_SOURCE`, `planes_px_SOURCE`, and the step of depth
// `step_SOURCE`.
Table noise_table(const MeasuredSensor& sensor);
// Table `widths_NAME` over jumps: the medians of the widths of holes, `SIDE_SOURCE`.
Table width_table(const MeasuredSensor& sensor);
// Table `holes_NAME` over the distance from the last pixel of the near surface: fractions of holes,
// `SIDE_SOURCE`.
Table hole_table(const MeasuredSensor& sensor);
// Table `truth` over frames: `median_`, `spread_` and `measured_` of OBJECT_SOURCE.
Table truth_table(const TrueObjectErrors& errors);

// Returns how fast the holes of a column of width_table() widen with the jump, as the length of a baseline.
// NaN if fewer than four widths are known.
double shadow_baseline_m(const Table& widths, const std::string& column, double focal_px);

}  // namespace remote_touch
