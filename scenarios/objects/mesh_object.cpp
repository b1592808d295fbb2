#include "scenarios/objects/mesh_object.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/mesh/triangle_mesh.h"
#include "core/points/vector.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

void require_increasing_times(const std::vector<StampedPose>& poses) {
  if (poses.empty()) throw std::invalid_argument("pose path: no pose: expected one or more");
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (!std::isfinite(poses[i].time_s) || (i > 0 && !(poses[i].time_s > poses[i - 1].time_s)))
      throw std::invalid_argument("pose path: time of pose " + std::to_string(i) +
                                  ": expected finite times, each above the one before");
}

void require_metres(const MeshSubject& names, const TriangleMesh& mesh) {
  constexpr double kMaxSize_m = 10;
  BoundingBox box;
  for (const auto& triangle : mesh.triangles)
    for (const int corner : triangle) box.extend(mesh.vertices[static_cast<std::size_t>(corner)]);
  const double size_m = box.diagonal().norm();
  if (!(size_m <= kMaxSize_m))
    refuse(names.subject, "its bounding box has a diagonal of ", size_m,
           " m: metres expected, these may be millimetres", names.if_large);
}

std::shared_ptr<const MeshDistance> distance_to(const std::string& subject, const TriangleMesh& mesh) {
  try {
    return std::make_shared<const MeshDistance>(mesh);
  } catch (const std::invalid_argument&) {
    refuse(subject, "no triangle has an area: expected a surface");
  }
}

}  // namespace

PosePath::PosePath(const RigidTransform& X) : PosePath(std::vector<StampedPose>{{0, X}}) {}

PosePath::PosePath(std::vector<StampedPose> poses) : poses_(std::move(poses)) {
  require_increasing_times(poses_);
  for (std::size_t i = 0; i + 1 < poses_.size(); ++i) {
    const Eigen::Matrix3d R = poses_[i].X.linear().transpose() * poses_[i + 1].X.linear();
    turns_.push_back(rotation_vector(Eigen::Quaterniond(R).normalized()));
  }
}

RigidTransform PosePath::at(double time_s) const {
  const auto is_earlier = [](double t, const StampedPose& pose) { return t < pose.time_s; };
  const auto next = std::upper_bound(poses_.begin(), poses_.end(), time_s, is_earlier);
  if (next == poses_.begin()) return poses_.front().X;
  const StampedPose& last = *(next - 1);
  if (next == poses_.end()) return last.X;
  const double share = (time_s - last.time_s) / (next->time_s - last.time_s);
  const Vec3& turn = turns_[static_cast<std::size_t>(next - poses_.begin()) - 1];
  RigidTransform X = RigidTransform::Identity();
  X.linear() = last.X.linear() * rotation(share * turn).toRotationMatrix();
  X.translation() = last.X.translation() + share * (next->X.translation() - last.X.translation());
  return X;
}

NearestOnObjects nearest_on_objects(std::span<const MeshObject> objects,
                                    std::span<const std::optional<RigidTransform>> X_PO, const Vec3& p_P,
                                    double reach_m) {
  assert(objects.size() == X_PO.size());
  NearestOnObjects result;
  if (!p_P.allFinite()) return result;
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (X_PO[i]) take_nearer(result, objects, i, *X_PO[i], p_P, reach_m);
  return result;
}

void take_nearer(NearestOnObjects& result, std::span<const MeshObject> objects, std::size_t i,
                 const RigidTransform& X_PO, const Vec3& p_P, double reach_m) {
  const auto nearest = objects[i].shape->nearest(X_PO.inverse() * p_P, reach_m);
  if (!nearest || (!objects[i].is_closed && nearest->on_border)) return;
  if (nearest->distance_m >= result.distance_m) return;  // false while the result is NaN
  result = {nearest->distance_m, X_PO.linear() * nearest->normal, static_cast<int>(i)};
}

std::vector<PosedMesh> posed_meshes(std::span<const MeshObject> objects,
                                    std::span<const std::optional<RigidTransform>> X_WO) {
  assert(objects.size() == X_WO.size());
  std::vector<PosedMesh> meshes;
  for (std::size_t i = 0; i < objects.size(); ++i)
    meshes.push_back({objects[i].name, objects[i].shape->vertices(), objects[i].shape->triangles(), X_WO[i],
                      objects[i].is_closed});
  return meshes;
}

MeshObject checked_object(const std::string& name, const TriangleMesh& mesh, std::optional<bool> closed,
                          const MeshSubject& names) {
  const MeshCheck check = check_mesh(mesh);
  if (!check.readable()) refuse(names.subject, text(check), ": expected a mesh of triangles");
  require_metres(names, mesh);
  MeshObject object{name, distance_to(names.subject, mesh)};
  object.is_closed = closed.value_or(object.shape->is_closed());
  if (!object.is_closed) return object;
  if (!object.shape->is_closed())
    refuse(names.subject, text(check), ": expected a closed mesh", names.if_open);
  if (object.shape->has_inverted_part())
    refuse(names.subject,
           check.inverted()          ? text(check)
           : signed_volume(mesh) < 0 ? "inside out"
                                     : "a part of the mesh is inside out",
           ": expected triangles counter-clockwise seen from outside", names.if_inverted);
  return object;
}

// Two additive recurrences spread the points within the triangles.
std::vector<SampledPoint> surface_samples(const MeshDistance& shape, std::size_t count) {
  constexpr double kAlong = 0.7548776662466927, kAcross = 0.5698402909980532;
  const std::vector<Vec3>& vertices = shape.vertices();
  std::vector<double> area_up_to;  // sum up to each triangle, times two
  double area = 0;
  for (const auto& [a, b, c] : shape.triangles())
    area_up_to.push_back(area += (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]).norm());
  std::vector<SampledPoint> samples;
  for (std::size_t k = 0; k < count; ++k) {
    const double place = area * (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    const auto found = std::upper_bound(area_up_to.begin(), area_up_to.end() - 1, place);
    const auto& [a, b, c] = shape.triangles()[static_cast<std::size_t>(found - area_up_to.begin())];
    const Vec3 side = vertices[b] - vertices[a], other = vertices[c] - vertices[a];
    double along = kAlong * static_cast<double>(k + 1), across = kAcross * static_cast<double>(k + 1);
    along -= std::floor(along), across -= std::floor(across);
    if (along + across > 1) along = 1 - along, across = 1 - across;
    samples.push_back({vertices[a] + along * side + across * other, side.cross(other).normalized()});
  }
  return samples;
}

std::optional<std::size_t> pixel_of(const CameraIntrinsics& camera, const Vec3& p_C) {
  if (!p_C.allFinite() || !(p_C.z() > 0)) return {};
  const double u = std::floor(camera.fx * p_C.x() / p_C.z() + camera.cx + 0.5);
  const double v = std::floor(camera.fy * p_C.y() / p_C.z() + camera.cy + 0.5);
  if (!(u >= 0 && v >= 0 && u < camera.width && v < camera.height)) return {};
  return static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(u);
}

std::size_t count_in_image(const std::vector<SampledPoint>& samples, const RigidTransform& X_CO,
                           const CameraIntrinsics& camera) {
  return static_cast<std::size_t>(std::count_if(
      samples.begin(), samples.end(),
      [&](const SampledPoint& sample) { return pixel_of(camera, X_CO * sample.point).has_value(); }));
}

}  // namespace remote_touch
