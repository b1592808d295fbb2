// Objects whose true surface is a mesh at a pose, and the nearest of them.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/vector.h"
#include "core/mesh/mesh_distance.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

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

}  // namespace remote_touch
