// A simulated depth sensor before a scene that a real one has recorded.
#pragma once

#include <span>
#include <vector>

#include "analysis/measures/image_measures.h"
#include "core/geometry/camera.h"
#include "core/kernels/kernels.h"
#include "core/numeric/noise.h"
#include "scenarios/camera/depth_sensor.h"
#include "scenarios/meshes/mesh_scene.h"
#include "scenarios/meshes/recorded_truth.h"

namespace remote_touch {

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

}  // namespace remote_touch
