// The surface of a rigid tool as points with which a slave robot touches the scene.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "core/geometry/vector.h"
#include "core/mesh/triangle_mesh.h"

namespace remote_touch {

// Frame T is that of the tool: its origin is the centre of mass, as in VoxelTool.
struct SlaveTool {
  std::vector<Vec3> points_T;
  std::vector<double> areas_m2;  // area of the part of the surface that each point stands for
  double gyration_m = 0;         // radius of gyration, sqrt(trace(I / m) / 3), for uniform density
  double reach_m = 0;            // largest distance of a point from the origin
};

// Samples the surface. The triangles are divided into parts whose sides are not longer than a spacing, and
// the area of each part is shared among its corners. Space is divided into cubes with this spacing as their
// side. Each cube keeps the corner that is farthest from the origin, with the area of all its corners, so
// edges and corners of the tool are not lost. The spacing is the smallest of a series that gives at most
// max_points. pre: mesh in frame T, with an area; inertia_m2: about the origin, divided by the mass.
SlaveTool make_slave_tool(const TriangleMesh& mesh, const Eigen::Matrix3d& inertia_m2, int max_points = 100);

// A tree of spheres around the points of a tool. It reduces the number of queries of the scene.
class SlaveToolTree {
 public:
  // pre: there is a point.
  explicit SlaveToolTree(const std::vector<Vec3>& points_T);

  // Calls visitor(point, distance_m) for every point whose signed distance is less than near_m, and for some
  // others; `point` is the index of the point, and distance_m is NaN if it is not known. Returns the smallest
  // distance of all points if it is less than near_m or exact_m. Otherwise returns +infinity or the distance
  // of some point. Returns NaN if there were calls and the distance was not known in any of them.
  // pre: distance(p_T) returns the signed distance of a position in m, or NaN; its Lipschitz constant is 1.
  template <class Distance, class Visitor>
  double visit(double near_m, double exact_m, const Distance& distance, const Visitor& visitor) const {
    Search search{near_m, exact_m};
    visit(0, search, distance, visitor);
    const bool is_unknown = search.has_visited && std::isinf(search.least_m);
    return is_unknown ? std::numeric_limits<double>::quiet_NaN() : search.least_m;
  }

 private:
  struct Node {
    Vec3 centre_T;
    double radius_m;
    int begin, end;             // in order_
    int left = -1, right = -1;  // nodes; -1 in a leaf
  };
  int add(int begin, int end);

  struct Search {
    double near_m, exact_m;
    double least_m = std::numeric_limits<double>::infinity();
    bool has_visited = false;
    double reach_m() const { return std::fmax(near_m, std::fmin(exact_m, least_m)); }
  };
  template <class Distance, class Visitor>
  void visit(int index, Search& search, const Distance& distance, const Visitor& visitor) const {
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (distance(node.centre_T) - node.radius_m >= search.reach_m()) return;  // false if it is not known
    if (node.left >= 0) {
      visit(node.left, search, distance, visitor);
      visit(node.right, search, distance, visitor);
      return;
    }
    search.has_visited = true;
    for (int i = node.begin; i < node.end; ++i) {
      const int point = order_[static_cast<std::size_t>(i)];
      const double distance_m = distance(points_T_[static_cast<std::size_t>(point)]);
      visitor(point, distance_m);
      search.least_m = std::fmin(search.least_m, distance_m);
    }
  }

  const std::vector<Vec3> points_T_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace remote_touch
