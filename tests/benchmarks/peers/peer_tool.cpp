#include "tests/benchmarks/peers/peer_tool.h"

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/octree/octree.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <octomap/octomap.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <tuple>
#include <unordered_map>

namespace remote_touch::peers {
namespace {

using Vector = Eigen::Vector3d;

// --- Bullet: a triangle around every point, all of them one mesh ---

// The unit is the millimetre, because Bullet compares lengths and areas with constants that are meant for
// bodies of about 1.
constexpr double kBulletUnits_per_m = 1000;

btScalar number(double x) {
  return static_cast<btScalar>(x);
}

btVector3 bullet_vector(const Coordinates& p) {
  return kBulletUnits_per_m * btVector3(number(p[0]), number(p[1]), number(p[2]));
}

// The corners run counter-clockwise seen from the side to which the normal points. The other side is inside
// for GImpact.
std::vector<Coordinates> triangle_around(const Coordinates& point, const Coordinates& normal, double side_m) {
  const Vector p(point.data()), n(normal.data()), a = n.unitOrthogonal(), b = n.cross(a);
  std::vector<Coordinates> corners;
  for (int i = 0; i < 3; ++i) {
    const double angle = 2 * 3.14159265358979323846 * i / 3;
    const Vector corner = p + side_m / std::sqrt(3.0) * (std::cos(angle) * a + std::sin(angle) * b);
    corners.push_back({corner.x(), corner.y(), corner.z()});
  }
  return corners;
}

struct GImpactBody {
  btTriangleMesh mesh;
  std::unique_ptr<btGImpactMeshShape> shape;
  btCollisionObject object;

  void add(const Coordinates& a, const Coordinates& b, const Coordinates& c) {
    mesh.addTriangle(bullet_vector(a), bullet_vector(b), bullet_vector(c));
  }
  // The margin is 0. A larger margin would also make the tree find triangles that are only near, and take
  // much longer.
  void make_tree() {
    shape = std::make_unique<btGImpactMeshShape>(&mesh);
    shape->setMargin(0);
    shape->updateBound();
    object.setCollisionShape(shape.get());
  }
};

// Uses contactPairTest(), which reports every contact; a manifold would keep only four of them.
class GImpact : btCollisionWorld::ContactResultCallback {
 public:
  GImpact(const MeshAndPoints& from, const std::vector<std::vector<Coordinates>>& bodies) {
    const int type = GIMPACT_SHAPE_PROXYTYPE;
    dispatcher_.registerCollisionCreateFunc(type, type, &algorithm_);
    dispatcher_.registerClosestPointsCreateFunc(type, type, &algorithm_);  // contactPairTest() needs it
    for (const auto& [a, b, c] : from.triangles)
      tool_.add(from.vertices[a], from.vertices[b], from.vertices[c]);
    for (const auto& body : bodies) points_.add(body[0], body[1], body[2]);
    tool_.make_tree(), points_.make_tree();
  }

  std::size_t touch(const Pose& pose) {
    const auto& R = pose.R_WT;
    const btMatrix3x3 turn(number(R[0]), number(R[1]), number(R[2]), number(R[3]), number(R[4]), number(R[5]),
                           number(R[6]), number(R[7]), number(R[8]));
    tool_.object.setWorldTransform(btTransform(turn, bullet_vector(pose.p_W)));
    touched_.clear();
    world_.contactPairTest(&tool_.object, &points_.object, *this);
    return touched_.size();
  }
  const std::vector<std::size_t>& touched() const { return touched_; }

 private:
  btScalar addSingleResult(btManifoldPoint& /*contact*/, const btCollisionObjectWrapper* /*tool*/,
                           int /*part*/, int /*triangle*/, const btCollisionObjectWrapper* /*points*/,
                           int /*part*/, int point) override {
    touched_.push_back(static_cast<std::size_t>(point));
    return 0;
  }

  btGImpactCollisionAlgorithm::CreateFunc algorithm_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btCollisionWorld world_{&dispatcher_, &broadphase_, &configuration_};
  GImpactBody tool_, points_;
  std::vector<std::size_t> touched_;
};

// Largest diagonal of the boxes around single triangles.
double max_diagonal(const MeshAndPoints& from) {
  double max_length = 0;
  for (const auto& [a, b, c] : from.triangles) {
    Vector low, high;
    for (int i = 0; i < 3; ++i)
      std::tie(low[i], high[i]) =
          std::minmax({from.vertices[a][i], from.vertices[b][i], from.vertices[c][i]});
    max_length = std::max(max_length, (high - low).norm());
  }
  return max_length;
}

// GImpact finds pairs of triangles whose boxes meet and that reach behind each other. These are more than the
// pairs that cross.
ToolPeer gimpact(const std::string& name, const MeshAndPoints& from, double side_m) {
  const double radius = side_m / std::sqrt(3.0);
  ToolPeer peer{name, {}, radius, std::sqrt(3.0) * radius + max_diagonal(from), {}, {}};
  for (std::size_t i = 0; i < from.points_W.size(); ++i)
    peer.bodies_W.push_back(triangle_around(from.points_W[i], from.normals_W[i], side_m));
  const auto collision = std::make_shared<GImpact>(from, peer.bodies_W);
  peer.touch = [=](const Pose& pose) { return collision->touch(pose); };
  peer.touched = [=] { return collision->touched(); };
  return peer;
}

// --- FCL: the points as the occupied cells of an octree ---

// Edge length of a cell, equal to that of our voxels. FCL takes longer with larger cells, which meet more
// triangles.
constexpr double kCell_m = 5e-4;

using Mesh = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<Mesh> mesh_with_tree(const MeshAndPoints& from) {
  std::vector<Vector> vertices;
  for (const Coordinates& v : from.vertices) vertices.emplace_back(v.data());
  std::vector<fcl::Triangle> triangles;
  for (const auto& [a, b, c] : from.triangles) triangles.emplace_back(a, b, c);
  auto mesh = std::make_shared<Mesh>();
  mesh->beginModel();
  mesh->addSubModel(vertices, triangles);
  mesh->endModel();
  mesh->computeLocalAABB();
  return mesh;
}

class Octree {
 public:
  explicit Octree(const MeshAndPoints& from)
      : cells_(std::make_shared<octomap::OcTree>(kCell_m)), mesh_(mesh_with_tree(from)) {
    for (const Coordinates& p : from.points_W) cells_->updateNode(p[0], p[1], p[2], true, true);
    cells_->updateInnerOccupancy();
    for (std::size_t i = 0; i < from.points_W.size(); ++i) {
      const Coordinates& p = from.points_W[i];
      points_in_[cells_->search(p[0], p[1], p[2]) - cells_->getRoot()].push_back(i);
    }
    octree_ = std::make_unique<fcl::OcTreed>(cells_);
    octree_->computeLocalAABB();
  }

  std::vector<Coordinates> cell_of(const Coordinates& p) const {
    const octomap::point3d centre = cells_->keyToCoord(cells_->coordToKey(p[0], p[1], p[2]));
    std::vector<Coordinates> corners(8);
    for (int i = 0; i < 8; ++i)
      corners[static_cast<std::size_t>(i)] = {centre.x() + kCell_m * ((i & 1) - 0.5),
                                              centre.y() + kCell_m * ((i >> 1 & 1) - 0.5),
                                              centre.z() + kCell_m * ((i >> 2) - 0.5)};
    return corners;
  }

  std::size_t touch(const Pose& pose, const fcl::CollisionRequestd& request) {
    fcl::Transform3d X_WT = fcl::Transform3d::Identity();
    X_WT.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.R_WT.data());
    X_WT.translation() = Vector(pose.p_W.data());
    result_.clear();
    fcl::collide(octree_.get(), fcl::Transform3d::Identity(), mesh_.get(), X_WT, request, result_);
    return result_.numContacts();
  }

  std::vector<std::size_t> touched() const {
    std::vector<std::size_t> points;
    for (std::size_t i = 0; i < result_.numContacts(); ++i) {
      const auto& in_cell = points_in_.at(result_.getContact(i).b1);
      points.insert(points.end(), in_cell.begin(), in_cell.end());
    }
    return points;
  }

 private:
  std::shared_ptr<octomap::OcTree> cells_;
  std::shared_ptr<Mesh> mesh_;
  std::unique_ptr<fcl::OcTreed> octree_;
  fcl::CollisionResultd result_;
  std::unordered_map<std::intptr_t, std::vector<std::size_t>> points_in_;  // keyed by FCL's cell index
};

// The peer finds pairs of cell and triangle without the points of contact, as our list does.
ToolPeer octree(const MeshAndPoints& from) {
  const auto collision = std::make_shared<Octree>(from);
  const double diagonal = std::sqrt(3.0) * kCell_m;
  ToolPeer peer{"fcl_octree", {}, diagonal, diagonal, {}, {}};
  for (const Coordinates& p : from.points_W) peer.bodies_W.push_back(collision->cell_of(p));
  const fcl::CollisionRequestd request(1'000'000, false);
  peer.touch = [=](const Pose& pose) { return collision->touch(pose, request); };
  peer.touched = [=] { return collision->touched(); };
  return peer;
}

}  // namespace

std::vector<ToolPeer> tool_peers(const MeshAndPoints& from) {
  // The triangles are as wide as a voxel of ours, and as wide as the points are apart.
  return {gimpact("bullet_gimpact_0.5mm", from, 5e-4), gimpact("bullet_gimpact_2mm", from, 2e-3),
          octree(from)};
}

}  // namespace remote_touch::peers
