// The places of the surfaces of objects in the image of a camera.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/geometry/point_cloud.h"
#include "core/geometry/vector.h"
#include "core/mesh/mesh_distance.h"

namespace remote_touch {

struct SampledPoint {
  Vec3 point, normal;  // frame of the object; the normal is a unit vector, outwards
};

// Returns points that are spread evenly over the area of a surface, the same ones in every call.
std::vector<SampledPoint> surface_samples(const MeshDistance& shape, std::size_t count);

// Returns the index v * width + u of the pixel nearest to the projection of p_C. Returns nothing outside the
// image, and unless p_C is finite and in front of the camera.
std::optional<std::size_t> pixel_of(const CameraIntrinsics& camera, const Vec3& p_C);

// Returns the number of points that are in the image, hidden or not. X_CO: object to camera frame.
std::size_t count_in_image(const std::vector<SampledPoint>& samples, const RigidTransform& X_CO,
                           const CameraIntrinsics& camera);

}  // namespace remote_touch
