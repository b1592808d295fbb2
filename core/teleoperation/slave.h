// Slave robots in contact with the true scene: a ball on a carriage that follows a commanded position, and a
// rigid tool that follows a commanded pose.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/parameters/parameter.h"
#include "core/points/noise.h"
#include "core/points/vector.h"

namespace remote_touch {

struct SlaveSettings {
  double mass_kg = 2;
  double natural_frequency_hz = 5;
  double damping_ratio = 1;
  double max_speed_m_per_s = 0;
  double max_acceleration_m_per_s2 = 0;
  double radius_m = 0.005;
  double contact_stiffness_N_per_m = 30000;
  double contact_damping_Ns_per_m = 20;
  int steps_per_tick = 10;
};

Parameters parameters(SlaveSettings& s);
std::string validate(const SlaveSettings& s);

// The scene that the ball touches: the true surface, not the measured points.
struct SlaveScene {
  // Distance of a point from the surface at a time, m, positive outside; NaN where it is not known.
  std::function<double(const Vec3& p_W, double time_s)> signed_distance;
  // Unit normal towards the outside at the surface point that is nearest; NaN where it is not known.
  std::function<Vec3(const Vec3& p_W, double time_s)> normal;
  // Time of the surface to which both refer: time_s, if the surface moves while time passes. Otherwise the
  // surface is at rest until the result changes, and then it jumps. Empty: time_s.
  std::function<double(double time_s)> surface_time_s = {};

  // True if the surface jumps between two times, so that it has no speed.
  bool jumps(double before_s, double now_s) const {
    if (!surface_time_s) return false;
    const double before = surface_time_s(before_s), now = surface_time_s(now_s);
    return before != now && !(before == before_s && now == now_s);
  }
};

// m x'' = m w^2 (c - x) + 2 zeta w m (c' - x') + f along every axis, with x the centre of the ball, c the
// reference, w = 2 pi natural_frequency_hz and f the contact force of the scene. In each tick the reference
// moves at constant velocity, not faster than max_speed_m_per_s, and reaches the command at the end. The
// drive, which is the first two terms divided by m, is limited to max_acceleration_m_per_s2 in magnitude.
//
// f = max(0, K d + B d') n, with d = radius_m - signed distance of the centre, where d > 0; n is the normal
// of the true surface where the ball touches first in a tick. d' includes the motion of the surface, but not
// a jump (SlaveScene::surface_time_s). There is no friction, and no contact where distance or normal are not
// known. A surface that approaches with more than 10 m/s may be noticed a tick later.
//
// The motion is integrated in steps of a tick / steps_per_tick by the semi-implicit rule. Its error is of
// the order of w T and sqrt(K / m) T, where T is the duration of a step.
class Slave {
 public:
  Slave(const SlaveSettings& settings, double tick_s, SlaveScene scene);

  struct State {
    Vec3 position_W = Vec3::Zero();
    Vec3 velocity_W = Vec3::Zero();
    Vec3 force_N = Vec3::Zero();  // mean force of the scene on the slave in the last tick, world frame
    double peak_force_N = 0;      // largest magnitude of the force in the last tick
    double clearance_m = 0;  // distance of the slave from the surface; negative in contact; NaN: not known
    // The reference c, its displacement and the mean force D of the drive on the slave in the last tick, and
    // the work D . c' of the reference on the drive and D . x' of the drive on the slave. Only of a ball.
    Vec3 reference_W = Vec3::Zero(), reference_displacement_m = Vec3::Zero(), drive_N = Vec3::Zero();
    double reference_work_J = 0, drive_work_J = 0;
    // False if the slave was behind the surface in the last tick and the normal there is not known. There is
    // then no force, because its direction is not known.
    bool is_force_known = true;
  };
  // Moves the slave from time_s - tick_s to time_s. command_W: the position that it has received last. In the
  // first call the slave is put at the command, at rest. If the last call was for an earlier time than
  // time_s - tick_s, the slave stood still meanwhile, and the scene has no known speed of approach.
  const State& move(const Vec3& command_W, double time_s);
  // A wave u with an impedance b > 0, which moves the reference: sqrt(2 b) u = b c' + D at every step, with
  // the force D of the drive on the slave. max_speed_m_per_s does not limit it.
  struct Wave {
    Vec3 value_W = Vec3::Zero();  // sqrt(W)
    double impedance_Ns_per_m = 0;
  };
  // Moves the slave by a wave in place of a command. pre: move() has put the slave somewhere.
  const State& move(const Wave& wave, double time_s);
  const State& state() const { return state_; }

 private:
  using Guide = std::variant<Vec3, Wave>;  // a velocity or a wave, which moves the reference in a tick
  Vec3 drive_acceleration(const Vec3& reference_velocity) const;
  Vec3 reference_velocity(const Guide& guide) const;
  Vec3 contact_force(double before_s, double now_s);
  bool is_far(const Vec3& reference_velocity) const;
  const State& move_through_tick(const Guide& guide, double time_s);
  void step(const Guide& guide, bool can_touch, double before_s, double now_s);

  const SlaveSettings s_;
  const double tick_s_;
  const SlaveScene scene_;
  State state_;
  double depth_m_ = 0;            // d after the last step; NaN: not known
  Vec3 depth_W_ = Vec3::Zero();   // position to which it belongs
  std::optional<Vec3> normal_W_;  // normal of the surface in this tick
  double last_s_ = 0;             // time of the last call
  bool is_placed_ = false;
};

// The parts of the drive that a ball and a tool share.

// Returns 2 pi natural_frequency_hz, 1/s.
inline double natural_rate_per_s(const SlaveSettings& s) {
  return 2 * std::numbers::pi * s.natural_frequency_hz;
}

// Returns the vector, shortened to max_length if it is longer; 0: no limit.
inline Vec3 cut(const Vec3& v, double max_length) {
  return max_length > 0 ? limited_length(v, max_length) : v;
}

// The error of the registration of the slave to the camera, whose cloud the operator touches.
struct RegistrationError {
  double offset_m = 0;
  double rotation_deg = 0;
  Vec3 centre_m = Vec3::Zero();
};

Parameters parameters(RegistrationError& s);
inline std::string validate(const RegistrationError&) {
  return {};
}

// Returns X with X p = R (p - o) + o + t, the position to which the slave moves if the command is p, both in
// the world frame. R is a rotation by rotation_deg, o is centre_m, and t has the length offset_m. So the
// rotation displaces a command at the distance d from o by up to 2 d sin(rotation_deg / 2). The axis of R and
// the direction of t are random, independent, uniform on the sphere, and the same for the whole run. They are
// functions of the seed and the replicate, not of the cell of a sweep, so the runs of one replicate differ
// only in what the sweep varies.
RigidTransform registration_of(const RegistrationError& error, const NoiseKey& key);

// The surface of a rigid tool as points with which a slave robot touches the scene. Frame T is that of the
// tool: its origin is the centre of mass, as in VoxelTool.
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
