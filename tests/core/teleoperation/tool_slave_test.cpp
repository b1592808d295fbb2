// The slave robot with a tool: closed forms of its free motion and its contact, and the ball as an oracle.
#include "core/teleoperation/slave.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>

#include "core/points/vector.h"

namespace remote_touch::tool_slave_test {
namespace {

constexpr double kTick_s = 0.001;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

SlaveScene plane(const Vec3& normal = Vec3::UnitY(), double rise_m_per_s = 0) {
  return {[=](const Vec3& p, double t) { return p.dot(normal) - rise_m_per_s * t; },
          [=](const Vec3&, double) { return normal; }};
}

SlaveScene nothing() {
  return {[](const Vec3&, double) { return kNaN; },
          [](const Vec3&, double) { return Vec3(Vec3::Constant(kNaN)); }};
}

// A plate of 8 x 8 cm, 1 cm thick, with 9 x 9 points on either side.
SlaveTool plate() {
  SlaveTool tool;
  for (const double y : {-0.005, 0.005})
    for (int i = -4; i <= 4; ++i)
      for (int k = -4; k <= 4; ++k) {
        tool.points_T.emplace_back(0.01 * i, y, 0.01 * k);
        tool.areas_m2.push_back(1e-4);
      }
  tool.gyration_m = std::sqrt((2 * 0.0064 + 0.0001) / 18), tool.reach_m = Vec3(0.04, 0.005, 0.04).norm();
  return tool;
}

// Points on a ball around the origin, the lowest of them at the bottom.
SlaveTool ball(double radius_m) {
  SlaveTool tool;
  for (int i = 0; i < 200; ++i) {
    const double y = i == 0 ? -1 : -1 + 2 * (i + 0.5) / 200, around = 2.399963229728653 * i;
    const double r = std::sqrt(1 - y * y);
    tool.points_T.push_back(radius_m * Vec3(r * std::cos(around), y, r * std::sin(around)));
    tool.areas_m2.push_back(1);
  }
  tool.reach_m = radius_m, tool.gyration_m = radius_m * std::sqrt(0.4);
  return tool;
}

ToolSlave::Pose pose(const Vec3& p, const Vec3& turn = Vec3::Zero()) {
  return {p, rotation(turn)};
}

double drive_stiffness(const SlaveSettings& s) {
  const double w = 2 * std::numbers::pi * s.natural_frequency_hz;
  return s.mass_kg * w * w;
}

TEST(ToolSlave, StartsAtTheFirstCommandAtRest) {
  ToolSlave slave({}, plate(), kTick_s, plane());
  const ToolSlave::State& state = slave.move(pose({1, 2, 3}, {0, 0, 0.5}), 0.5);
  EXPECT_EQ(state.position_W, Vec3(1, 2, 3));
  EXPECT_NEAR(state.orientation_W.angularDistance(rotation({0, 0, 0.5})), 0, 1e-12);
  EXPECT_EQ(state.velocity_W, Vec3::Zero());
  EXPECT_EQ(state.angular_velocity_W, Vec3::Zero());
  const double lowest = -0.04 * std::sin(0.5) - 0.005 * std::cos(0.5);
  EXPECT_NEAR(state.clearance_m, 2 + lowest, 1e-12);
}

// A sine in free space, of the position and about an axis of the world: the response of a second-order system
// whose drive knows the speed of its command.
TEST(ToolSlave, FollowsASineInPositionAndOrientation) {
  const Vec3 axis = Vec3(1, 2, -1).normalized();
  for (const double natural_hz : {1.0, 5.0, 20.0})
    for (const double signal_hz : {0.5, 2.0, 8.0}) {
      SCOPED_TRACE(testing::Message() << natural_hz << " " << signal_hz);
      SlaveSettings s;
      s.natural_frequency_hz = natural_hz, s.steps_per_tick = 20;
      s.damping_ratio = signal_hz == 2 ? 0.5 : 1;
      ToolSlave slave(s, plate(), kTick_s, nothing());
      const double w = 2 * std::numbers::pi * natural_hz, u = 2 * std::numbers::pi * signal_hz;
      std::complex<double> moved = 0, turned = 0;
      const int settle = 8000, window = static_cast<int>(std::lround(4 / signal_hz / kTick_s));
      for (int tick = 0; tick < settle + window; ++tick) {
        const double t = tick * kTick_s;
        const ToolSlave::State& state =
            slave.move(pose({0, 0.1 * std::sin(u * t), 0}, 0.3 * std::sin(u * t) * axis), t);
        if (tick < settle) continue;
        const std::complex<double> turn = std::exp(std::complex<double>(0, -u * t)) * (2.0 / window);
        moved += state.position_W.y() / 0.1 * turn;
        turned += rotation_vector(state.orientation_W).dot(axis) / 0.3 * turn;
      }
      const std::complex<double> i(0, 1), damper = i * 2.0 * s.damping_ratio * w * u;
      const std::complex<double> expected = (w * w + damper) / (w * w - u * u + damper);
      for (const std::complex<double> sum : {moved, turned}) {
        const std::complex<double> measured = sum * i;
        EXPECT_NEAR(std::abs(measured), std::abs(expected), 0.01 * std::abs(expected));
        EXPECT_NEAR(std::arg(measured / expected) / u, 0, 0.05 * kTick_s);
      }
    }
}

TEST(ToolSlave, TurnsTheShorterWayWithinItsLimits) {
  SlaveSettings s;
  s.max_speed_m_per_s = 0.05, s.max_acceleration_m_per_s2 = 2;
  const SlaveTool tool = plate();
  ToolSlave slave(s, tool, kTick_s, nothing());
  slave.move(pose({0, 0, 0}), 0);
  const ToolSlave::Pose target = {Vec3::Zero(), Eigen::Quaterniond(-rotation({0, 2, 0}).coeffs())};
  Vec3 before = Vec3::Zero();
  double hardest = 0, fastest = 0;
  for (int tick = 1; tick < 6000; ++tick) {
    const Vec3 rate = slave.move(target, tick * kTick_s).angular_velocity_W;
    if (tick < 300) {
      EXPECT_GT(rate.y(), 0) << tick;
    }
    hardest = std::max(hardest, (rate - before).norm() / kTick_s), fastest = std::max(fastest, rate.norm());
    before = rate;
  }
  EXPECT_NEAR(hardest, 2 / tool.gyration_m, 1e-6);
  EXPECT_LT(fastest, 1.5 * 0.05 / tool.gyration_m);
  EXPECT_NEAR(slave.state().orientation_W.angularDistance(rotation({0, 2, 0})), 0, 1e-6);
}

// A small ball of points is the ball of Slave, within twice the rounding of the depths, on a surface at rest
// and on one that rises.
TEST(ToolSlave, AgreesWithTheBall) {
  for (const double rise_m_per_s : {0.0, 0.05}) {
    SlaveSettings s;
    s.radius_m = 0.005, s.max_speed_m_per_s = 0.5;
    if (rise_m_per_s > 0) s.natural_frequency_hz = 7, s.damping_ratio = 0.7;
    const SlaveScene scene = plane(Vec3::UnitY(), rise_m_per_s);
    Slave oracle(s, kTick_s, scene);
    ToolSlave slave(s, ball(0.005), kTick_s, scene);
    double largest_N = 0;
    for (int tick = 0; tick < 3000; ++tick) {
      const double t = tick * kTick_s;
      const Vec3 command(0.02 * std::sin(5 * t), 0.02 * std::cos(9 * t) + rise_m_per_s * t, 0);
      const Slave::State& ball = oracle.move(command, t);
      const ToolSlave::State& tool = slave.move(pose(command), t);
      ASSERT_NEAR((tool.position_W - ball.position_W).norm(), 0, 2 * ToolSlave::kRounding_m) << tick;
      ASSERT_NEAR(tool.clearance_m, ball.clearance_m, 2 * ToolSlave::kRounding_m) << tick;
      ASSERT_NEAR((tool.force_N - ball.force_N).norm(), 0, 3) << tick;
      largest_N = std::max(largest_N, ball.peak_force_N);
    }
    EXPECT_GT(largest_N, 30);
  }
}

// Static: the drive is in balance with K g, and a face of n points has g = d + s ln n.
TEST(ToolSlave, AFlatPlatePressesWithTheForceOfItsDrive) {
  for (const Vec3& n : {Vec3(0, 1, 0), Vec3(Vec3(0.2, 1, -0.3).normalized())}) {
    const Vec3 tilt = rotation_vector(Eigen::Quaterniond::FromTwoVectors(Vec3::UnitY(), n));
    SlaveSettings s;
    ToolSlave slave(s, plate(), kTick_s, plane(n));
    const double error = 0.01;
    for (int tick = 0; tick < 4000; ++tick)
      slave.move(pose((tick == 0 ? 0.02 : 0.005 - error) * n, tilt), tick * kTick_s);
    const double k = s.contact_stiffness_N_per_m, offset = ToolSlave::kRounding_m * std::log(81);
    const double depth = (drive_stiffness(s) * error - k * offset) / (drive_stiffness(s) + k);
    const ToolSlave::State& state = slave.state();
    EXPECT_NEAR(state.clearance_m, -depth, 1e-8);
    const Vec3 to_command = (0.005 - error) * n - state.position_W;
    EXPECT_NEAR((state.force_N + drive_stiffness(s) * to_command).norm(), 0, 1e-4);
    EXPECT_NEAR((state.force_N - k * (depth + offset) * n).norm(), 0, 1e-4);
    EXPECT_NEAR(state.torque_Nm.norm(), 0, 1e-6);
    EXPECT_NEAR(state.orientation_W.angularDistance(rotation(tilt)), 0, 1e-8);
  }
}

// One point off the centre: the torque is lever x force, in balance with the drive of the orientation.
TEST(ToolSlave, AnOffCentreContactTurnsTheTool) {
  SlaveTool tool{{{0.03, -0.02, 0.01}}, {1e-4}, 0.04, 0.05};
  SlaveSettings s;
  ToolSlave slave(s, tool, kTick_s, plane());
  const Vec3 command(0, 0.015, 0);
  for (int tick = 0; tick < 6000; ++tick)
    slave.move(pose(tick == 0 ? Vec3(0, 0.05, 0) : command), tick * kTick_s);
  const ToolSlave::State& state = slave.state();
  EXPECT_GT(state.force_N.y(), 1);
  EXPECT_NEAR((state.force_N - drive_stiffness(s) * (state.position_W - command)).norm(), 0, 1e-3);
  const Vec3 arm = state.orientation_W * tool.points_T[0];
  EXPECT_NEAR((state.torque_Nm - arm.cross(state.force_N)).norm(), 0, 1e-6);
  const Vec3 turned = rotation_vector(state.orientation_W);
  EXPECT_GT(turned.norm(), 0.05);
  EXPECT_NEAR((state.torque_Nm - drive_stiffness(s) * 0.0016 * turned).norm(), 0, 1e-3);
}

// Thrown against a surface without damping, a plate at any tilt leaves with no more energy than it had.
TEST(ToolSlave, GainsNoEnergyInAnUndampedContact) {
  for (const double tilt : {0.0, 0.003, 0.02, 0.1, 0.5}) {
    SlaveSettings s;
    s.natural_frequency_hz = 0.1, s.damping_ratio = 0.05, s.contact_damping_Ns_per_m = 0,
    s.steps_per_tick = 40;
    const SlaveTool tool = plate();
    ToolSlave slave(s, tool, kTick_s, plane());
    const auto kinetic = [&] {
      const ToolSlave::State& at = slave.state();
      return 0.5 * s.mass_kg *
             (at.velocity_W.squaredNorm() +
              tool.gyration_m * tool.gyration_m * at.angular_velocity_W.squaredNorm());
    };
    const Vec3 turn(tilt, 0, 0.3 * tilt);
    slave.move(pose({0, 0.04, 0}, turn), 0);
    double arriving = 0, work = 0;
    bool has_touched = false;
    for (int tick = 1; tick < 3000; ++tick) {
      const double before = kinetic(), push = s.mass_kg * std::pow(0.2 * std::numbers::pi, 2) * 2;
      const double y = slave.state().position_W.y();
      const ToolSlave::State& state = slave.move(pose({0, -2, 0}, turn), tick * kTick_s);
      if (state.peak_force_N > 0 && !has_touched) arriving = before, has_touched = true;
      if (has_touched) work += push * (y - state.position_W.y());
      if (has_touched && state.clearance_m > 0.002) break;
    }
    ASSERT_TRUE(has_touched) << tilt;
    ASSERT_GT(slave.state().clearance_m, 0.002) << tilt;
    EXPECT_LT(kinetic(), 1.02 * arriving + work + 1e-3) << tilt;
    EXPECT_GT(kinetic(), 0.9 * arriving + work - 1e-3) << tilt;
  }
}

// A jump of the surface loads the spring and has no speed, at any length of the tick.
TEST(ToolSlave, NoDamperActsOverAJumpOfTheSurface) {
  const auto surface_s = [](double t) { return t < 0.4995 ? 0 : 0.4995; };
  const SlaveScene scene{[&](const Vec3& p, double t) { return p.y() - (surface_s(t) > 0 ? 0.002 : 0); },
                         plane().normal, surface_s};
  for (const double tick_s : {0.001, 0.00025}) {
    ToolSlave slave({}, plate(), tick_s, scene);
    double resting_N = 0, peak_N = 0;
    for (int tick = 0; tick * tick_s < 0.6; ++tick) {
      const double now_N = slave.move(pose({0, 0.005, 0}), tick * tick_s).peak_force_N;
      peak_N = std::max(peak_N, now_N);
      if (tick * tick_s < 0.4995) resting_N = now_N;
    }
    EXPECT_NEAR(peak_N, resting_N + SlaveSettings{}.contact_stiffness_N_per_m * 0.002, 0.5) << tick_s;
  }
}

// The resultant moves over the plate without a jump while it rocks from one edge to the other.
TEST(ToolSlave, ForceAndTorqueAreContinuousWhileThePlateRocks) {
  SlaveSettings s;
  s.natural_frequency_hz = 10;
  ToolSlave slave(s, plate(), kTick_s, plane());
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  double forces = 0, torques = 0, left = 0, right = 0;
  for (int tick = 0; tick < 6000; ++tick) {
    const double t = tick * kTick_s;
    const ToolSlave::State& state =
        slave.move(pose({0, tick == 0 ? 0.02 : 0.003, 0}, {0, 0, 0.05 * std::sin(2 * t)}), t);
    if (tick > 1000) {
      forces = std::max(forces, (state.force_N - force).norm());
      torques = std::max(torques, (state.torque_Nm - torque).norm());
      left = std::min(left, state.torque_Nm.z()), right = std::max(right, state.torque_Nm.z());
    }
    force = state.force_N, torque = state.torque_Nm;
  }
  EXPECT_LT(left, -0.1);
  EXPECT_GT(right, 0.1);
  EXPECT_LT(forces, 1);
  EXPECT_LT(torques, 0.1 * (right - left));
}

// The force is not known behind a surface whose normal is not known.
TEST(ToolSlave, TouchesNothingWhereTheSurfaceIsNotKnown) {
  for (const bool knows_distance : {false, true}) {
    const SlaveScene scene = knows_distance ? plane() : nothing();
    ToolSlave slave({}, plate(), kTick_s, {scene.signed_distance, nothing().normal});
    for (int tick = 0; tick < 100; ++tick) slave.move(pose({0, -0.01, 0}), tick * kTick_s);
    EXPECT_EQ(slave.state().force_N, Vec3::Zero());
    EXPECT_EQ(std::isnan(slave.state().clearance_m), !knows_distance);
    EXPECT_EQ(slave.state().is_force_known, !knows_distance);
  }
}

TEST(ToolSlave, NeedsMoreStepsForALongTool) {
  SlaveSettings s;
  s.mass_kg = 0.1, s.contact_stiffness_N_per_m = 3e5;
  SlaveTool tool = plate();
  s.steps_per_tick = 1000;
  EXPECT_EQ(validate(s, tool, kTick_s), "");
  s.steps_per_tick = 2;
  EXPECT_NE(validate(s, tool, kTick_s).find("steps_per_tick = 2"), std::string::npos);
}

TEST(SlaveTool, KeepsCornersAndTheWholeArea) {
  const Vec3 half(0.05, 0.005, 0.03);
  const SlaveTool tool = make_slave_tool(box_mesh(2 * half), Eigen::Vector3d(3, 4, 5).asDiagonal(), 200);
  ASSERT_LE(tool.points_T.size(), 200u);
  EXPECT_GT(tool.points_T.size(), 100u);
  double area = 0, outside = 0;
  for (const double a : tool.areas_m2) area += a;
  EXPECT_NEAR(area, 8 * (half.x() * half.y() + half.y() * half.z() + half.x() * half.z()), 1e-12);
  int corners = 0;
  for (const Vec3& p : tool.points_T) {
    corners += (p.cwiseAbs() - half).norm() < 1e-12;
    outside = std::max(outside, std::abs((p.cwiseAbs() - half).maxCoeff()));
  }
  EXPECT_EQ(corners, 8);
  EXPECT_LT(outside, 1e-12) << "all points are on the surface";
  EXPECT_NEAR(tool.reach_m, half.norm(), 1e-12);
  EXPECT_NEAR(tool.gyration_m, 2, 1e-12);
}

// Against all points one by one, with a ball as the surface.
TEST(SlaveToolTree, VisitsEveryPointThatIsNear) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-0.1, 0.1);
  const SlaveTool tool = plate();
  const SlaveToolTree tree(tool.points_T);
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 centre(any(random), any(random), any(random));
    const auto distance = [&](const Vec3& p) { return (p - centre).norm() - 0.03; };
    std::vector<int> visits(tool.points_T.size());
    const double near_m = std::abs(any(random)), exact_m = std::abs(any(random));
    double least = std::numeric_limits<double>::infinity();
    const double found = tree.visit(near_m, exact_m, distance, [&](int i, double d) {
      EXPECT_EQ(d, distance(tool.points_T[static_cast<std::size_t>(i)]));
      ++visits[static_cast<std::size_t>(i)];
    });
    for (std::size_t i = 0; i < tool.points_T.size(); ++i) {
      least = std::min(least, distance(tool.points_T[i]));
      EXPECT_LE(visits[i], 1);
      if (distance(tool.points_T[i]) < near_m) {
        EXPECT_EQ(visits[i], 1) << trial;
      }
    }
    if (least < std::max(near_m, exact_m)) {
      EXPECT_EQ(found, least);
    }
  }
}

}  // namespace
}  // namespace remote_touch::tool_slave_test
