// A slave robot with a rigid tool in contact with the true scene. It follows a commanded pose.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/geometry/vector.h"
#include "core/mesh/triangle_mesh.h"
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

// The centre of mass of the tool follows the commanded position as the ball of a Slave does, with the same
// drive and limits. The orientation follows its command in the same way, about every axis through the centre:
//
//   w_dot = w_0^2 e + 2 zeta w_0 (w_c - w) + tau / (m r^2),
//
// where e is the rotation vector from the orientation to the reference, w and w_c are the angular velocities
// of tool and reference, tau is the torque of the contact, all in the world frame, and w_0 = 2 pi
// natural_frequency_hz. The moment of inertia is m r^2 about every axis, with the mass m of the slave and the
// radius of gyration r of its tool. The limits of rotation are max_speed_m_per_s / r and
// max_acceleration_m_per_s2 / r.
//
// Contact: point i of the tool has the depth d_i, the distance behind the true surface, negative outside, the
// normal n_i of the surface, and the weight a_i, its area divided by the mean area. The force is that of a
// spring on one depth of the whole tool,
//
//   g = s ln(sum a_i exp(d_i / s)), F = max(0, K g + B g') where g > 0, f_i = F q_i n_i,
//   q_i = a_i exp(d_i / s) / sum a_j exp(d_j / s), s = kRounding_m.
//
// - g is a smooth maximum of the depths. A single point has g = d + s ln a, which is about d. So a point, an
//   edge and a face have the same stiffness K as the ball. A face of n points with mean area has
//   g = d + s ln n, so a tool of 100 points is pushed up to 0.23 mm before it touches.
// - The share q_i is the derivative of g by d_i. So the spring has the potential K g^2 / 2 and creates no
//   energy, and the damper removes the power B g'^2. Force and torque are continuous while the contact moves
//   over the tool: the resultant of a face acts where the face is deepest, within F / K and s.
// - With a spring at every point instead, the stiffness of a face would grow with the number of its points.
//   If these springs shared K, a corner of the tool would be soft.
// There is no friction, and no contact where distance or normal are not known. is_force_known is false if
// points are behind the surface and the normal is known at none of them.
//
// Steps: the scene is queried per tick, not in each of the steps_per_tick. At the start of a tick each point
// that may touch in it finds the tangent plane at its nearest surface point. The speed of this plane is the
// change of the distance of the initial position over the tick, or 0 if the surface jumps in it. In the steps
// the point touches this plane, and the rotation since the start is treated as small. The error of a depth is
// of the order of x^2 / (2 R), where x is the path of the point in a tick and R the radius of curvature of
// surface or path: 0.1 um for 0.1 m/s and 50 mm. A point may touch if it is nearer than 2 v T +
// kSceneSpeed_m_per_s T, where v is a bound of the speed of the points and T the duration of a tick. So a
// surface that approaches faster than kSceneSpeed_m_per_s may be felt one tick late.
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

  // pre: both validate() are empty, tick_s > 0.
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
