// The surface of a rigid tool as points that a slave robot touches the scene with.
#pragma once

#include <functional>
#include <vector>

#include "core/geometry/vector.h"
#include "core/mesh/triangle_mesh.h"

namespace remote_touch {

// Frame T is that of the tool: its origin is the centre of mass, as in VoxelTool.
struct SlaveTool {
  std::vector<Vec3> points_T;
  std::vector<double> areas_m2;  // of the part of the surface that each point stands for
  double gyration_m = 0;         // radius of gyration, sqrt(trace(I / m) / 3), of uniform density
  double reach_m = 0;            // largest distance of a point from the origin
};

// Samples the surface. The triangles are divided into parts that are not longer than a spacing, and the
// corners of the parts share their area. Of all corners in a cube whose side is the spacing, that which is
// farthest from the origin is kept with the area of all, so edges and corners of the tool are not lost. The
// spacing is the smallest of a series that gives no more than max_points.
// pre: mesh in frame T, with an area; inertia_m2: about the origin, divided by the mass.
SlaveTool make_slave_tool(const TriangleMesh& mesh, const Eigen::Matrix3d& inertia_m2, int max_points = 200);

// Spheres around the points of a tool, so that few positions of the scene need to be asked.
class SlaveToolTree {
 public:
  explicit SlaveToolTree(const std::vector<Vec3>& points_T);

  using Distance = std::function<double(const Vec3& p_T)>;
  using Visit = std::function<void(int point, double distance_m)>;
  // Visits at least all points that are nearer to the surface than near_m or whose distance is not known.
  // Returns the smallest distance of a visited point; +infinity if there is none, NaN if none is known.
  // pre: distance is Lipschitz with 1, as a distance is.
  double visit(double near_m, const Distance& distance, const Visit& visit) const;

 private:
  struct Node {
    Vec3 centre_T;
    double radius_m;
    int begin, end;             // in order_
    int left = -1, right = -1;  // nodes; -1 in a leaf
  };
  int add(int begin, int end);
  double visit(const Node& node, double near_m, const Distance& distance, const Visit& visit) const;

  const std::vector<Vec3> points_T_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace remote_touch
