// A slave robot with a rigid tool in contact with the true scene. It follows a commanded pose.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/points/vector.h"
#include "core/teleoperation/slave.h"

namespace remote_touch {

// The surface of a rigid tool as points with which a slave robot touches the scene.

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

// The centre of mass of the tool follows the commanded position as the ball of a Slave does. The orientation
// follows its command in the same way, about every axis through the centre:
//
//   w_dot = w_0^2 e + 2 zeta w_0 (w_c - w) + tau / (m r^2)
//
// with the rotation vector e from the orientation to the reference, the angular velocities w and w_c of both,
// the torque tau of the contact (all in the world frame), and the radius of gyration r. The limits of
// rotation are those of translation divided by r. Point i of the tool has the depth d_i behind the true
// surface, the normal n_i, and the weight a_i, its area divided by the mean area. The force on it is f_i = F
// q_i n_i,
//
//   g = s ln(sum a_i exp(d_i / s)), F = max(0, K g + B g') where g > 0,
//   q_i = a_i exp(d_i / s) / sum a_j exp(d_j / s), s = kRounding_m.
//
// There is no friction, and no contact where distance or normal are not known. is_force_known is false if
// points are behind the surface and the normal is known at none of them. What follows from these equations,
// and how the scene is queried: README.md of runners/experiment/hand.
class ToolSlave {
 public:
  static constexpr double kRounding_m = 5e-5;
  static constexpr double kSceneSpeed_m_per_s = 2;

  struct Pose {
    Vec3 position_W = Vec3::Zero();  // position of the tool's centre of mass
    Eigen::Quaterniond orientation_W = Eigen::Quaterniond::Identity();
  };
  // The position is that of the centre of mass. clearance_m is the least distance of a point of the tool from
  // the surface, exact below kExactClearance_m. Otherwise it is the distance of the point that is foremost
  // against the normal at the centre of mass. This is exact over a plane. If that normal is not known, it is
  // a lower bound. NaN: not known. A face is pushed before it touches, at a clearance of up to s ln n.
  struct State : Slave::State {
    Eigen::Quaterniond orientation_W = Eigen::Quaterniond::Identity();
    Vec3 angular_velocity_W = Vec3::Zero();
    Vec3 torque_Nm = Vec3::Zero();  // mean torque about the centre of mass in the last tick, world frame
  };
  static constexpr double kExactClearance_m = 0.01;

  ToolSlave(const SlaveSettings& settings, const SlaveTool& tool, double tick_s, SlaveScene scene);

  // Moves the slave as Slave::move() does. pre: the command is finite, its orientation a unit quaternion.
  const State& move(const Pose& command, double time_s);
  const State& state() const { return state_; }

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;  // a linear part and an angular one, about the centre of mass
  // A point that may touch in this tick. Its depth falls by `normal` times the displacement of the tool since
  // the start of the tick, and by rate_m_per_s times the time: normal = (n, arm x n).
  struct Touch {
    Vector6 normal;
    double weight, start_m;
    double rate_m_per_s;  // speed of the surface, positive if it recedes
    double depth_m;       // now
    Vec3 arm_W;           // from the centre of mass, at the start of the tick
  };
  // Motion of the reference in this tick, and its distance from the tool at the start.
  struct Drive {
    Vector6 rate_per_s, error;
  };
  void find_touches(double time_s);
  double clearance(double least_m, double time_s) const;
  void ask_scene(double begin_s, double end_s);
  Drive start_drive(const Pose& command);
  Vector6 contact_wrench(const Vector6& moved, const Vector6& velocity, double since_s);
  Vector6 drive(const Drive& drive, const Vector6& moved, const Vector6& velocity, double since_s) const;
  void move_through_tick(const Drive& drive);

  const SlaveSettings s_;
  const SlaveTool tool_;
  const SlaveToolTree tree_;
  const double tick_s_, mean_area_m2_;
  const SlaveScene scene_;
  State state_;
  Pose reference_;
  std::vector<Touch> touches_;
  double last_s_ = 0;
  bool is_placed_ = false;
};

// Returns the reason why the steps are too long for the contact of this tool, else nothing.
std::string validate(const SlaveSettings& s, const SlaveTool& tool, double tick_s);

}  // namespace remote_touch
