#include "scenarios/meshes/mesh_object.h"

#include <cassert>
#include <cstddef>

namespace remote_touch {

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
    meshes.push_back({objects[i].name, objects[i].shape->vertices(), objects[i].shape->triangles(), X_WO[i]});
  return meshes;
}

}  // namespace remote_touch
