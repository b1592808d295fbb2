// Objects whose true surface is a mesh: their poses over time, checks of what a user names, and their places
// in an image.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/mesh/mesh_distance.h"
#include "core/mesh/triangle_mesh.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "scenarios/scene/scenario.h"

namespace remote_touch {

// The pose of a rigid body as a function of time.

struct StampedPose {
  double time_s = 0;
  RigidTransform X = RigidTransform::Identity();  // frame of the body to its parent frame
};

// Passes through given poses. Between two of them the origin of the body moves on a straight line at constant
// speed, and the body turns about a constant axis, by the shorter way, at constant rate. The bits are the
// same on every machine.
class PosePath {
 public:
  // A body that rests.
  explicit PosePath(const RigidTransform& X);
  // Throws std::invalid_argument unless there is a pose, and the times are finite and strictly increasing.
  explicit PosePath(std::vector<StampedPose> poses);

  // Returns the pose at a time. Before the first time it is the first pose, after the last time the last
  // pose.
  RigidTransform at(double time_s) const;

  // The time of the last pose, from which the body rests.
  double duration_s() const { return poses_.back().time_s; }
  const std::vector<StampedPose>& poses() const { return poses_; }

 private:
  std::vector<StampedPose> poses_;
  std::vector<Vec3> turns_;  // rotation vector from each pose but the last to the next, in the body's frame
};

// Objects whose true surface is a mesh at a pose, and the nearest of them.

struct MeshObject {
  std::string name;
  std::shared_ptr<const MeshDistance> shape;  // frame of the object
  bool is_closed = true;  // false: a sheet, such as a table; nothing is known beyond its border
};

// The true surface nearest to a position, in the frame P of that position.
struct NearestOnObjects {
  double distance_m = std::numeric_limits<double>::quiet_NaN();  // positive outside; NaN: unknown
  // Unit normal of the surface at the nearest point, outwards; NaN: unknown.
  Vec3 normal = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  int object = -1;  // index of the object; -1: unknown
};

// Returns the object with the smallest signed distance to p_P. Outside of closed objects this is the distance
// to their union. Of several objects with that distance it is the first.
//
// X_PO[i] is the pose of objects[i]: its frame O to the frame P. An object is ignored if it has no pose, if
// it is not nearer than reach_m, or if it is open and its nearest point is on its border. The result is
// unknown if all objects are ignored, or if p_P is not finite. Pre: as many poses as objects, reach_m > 0.
NearestOnObjects nearest_on_objects(std::span<const MeshObject> objects,
                                    std::span<const std::optional<RigidTransform>> X_PO, const Vec3& p_P,
                                    double reach_m);

// Replaces the result by objects[i] if that is nearer, by the same rules. Does not allocate. Pre: p_P is
// finite.
void take_nearer(NearestOnObjects& result, std::span<const MeshObject> objects, std::size_t i,
                 const RigidTransform& X_PO, const Vec3& p_P, double reach_m);

// Returns the surfaces of the objects at their poses X_WO. Pre: as many poses as objects.
std::vector<PosedMesh> posed_meshes(std::span<const MeshObject> objects,
                                    std::span<const std::optional<RigidTransform>> X_WO);

// Objects of meshes that a user names: a mesh that cannot be a true surface is refused with the reason.

// The words of messages about a mesh.
struct MeshSubject {
  std::string subject;  // the refused part: the file, or the parameter and its value
  // Advice to a user: these continue the messages about an open mesh, one of clockwise triangles, and one
  // of more than 10 m.
  std::string if_open = {}, if_inverted = {}, if_large = {};
};

// closed: true for a solid, false for a sheet; nothing: as MeshDistance::is_closed() finds.
//
// Throws InputError about the subject in these cases: the mesh has no triangle with an area, or an index or
// vertex that cannot be used; its bounding box has a diagonal above 10 m; it should be closed and is not; or
// it is closed and the triangles of a part run clockwise seen from outside.
MeshObject checked_object(const std::string& name, const TriangleMesh& mesh, std::optional<bool> closed,
                          const MeshSubject& names);

// The places of the surfaces of objects in the image of a camera.

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
