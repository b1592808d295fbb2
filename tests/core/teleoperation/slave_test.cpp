// The slave robot: closed forms of its free motion, of its limits and of its contact; and its registration.
#include "core/teleoperation/slave.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/points/vector.h"

namespace remote_touch::slave_test {
namespace {

constexpr double kTick_s = 0.001;

// A horizontal plane at a height that may change with time.
SlaveScene plane(std::function<double(double)> height = [](double) { return 0.0; }) {
  return {[height](const Vec3& p, double t) { return p.y() - height(t); },
          [](const Vec3&, double) { return Vec3(0, 1, 0); }};
}

SlaveScene nothing() {
  return {[](const Vec3&, double) { return std::numeric_limits<double>::quiet_NaN(); },
          [](const Vec3&, double) { return Vec3(Vec3::Constant(std::numeric_limits<double>::quiet_NaN())); }};
}

// Static: m w^2 (c - x) + K d = 0 with d = r - x.
TEST(Slave, PressesWithTheForceOfItsDrive) {
  SlaveSettings s;
  Slave slave(s, kTick_s, plane());
  for (int tick = 0; tick < 5000; ++tick) slave.move({0, tick == 0 ? 0.01 : -0.01, 0}, tick * kTick_s);
  const double w = 2 * std::numbers::pi * s.natural_frequency_hz, drive = s.mass_kg * w * w;
  const double k = s.contact_stiffness_N_per_m;
  const double depth = drive * (s.radius_m + 0.01) / (drive + k);
  EXPECT_NEAR(slave.state().clearance_m, -depth, 1e-9);
  EXPECT_NEAR(slave.state().force_N.y(), k * depth, 1e-5);
  EXPECT_NEAR(slave.state().peak_force_N, k * depth, 1e-5);
}

TEST(Slave, KeepsItsLimits) {
  SlaveSettings s;
  s.max_speed_m_per_s = 0.2, s.max_acceleration_m_per_s2 = 3;
  Slave slave(s, kTick_s, nothing());
  slave.move({0, 0, 0}, 0);
  Vec3 before = Vec3::Zero();
  double fastest = 0, hardest = 0;
  for (int tick = 1; tick < 4000; ++tick) {
    const Slave::State& state = slave.move({0.3, 0.4, 0}, tick * kTick_s);
    fastest = std::max(fastest, state.velocity_W.norm());
    hardest = std::max(hardest, (state.velocity_W - before).norm() / kTick_s);
    before = state.velocity_W;
  }
  EXPECT_NEAR(hardest, 3, 1e-9);
  // The slave is late at first and catches up faster than the reference, which arrives after 2.5 s.
  EXPECT_GT(fastest, 0.2);
  EXPECT_LT(fastest, 0.3);
  EXPECT_NEAR((slave.state().position_W - Vec3(0.3, 0.4, 0)).norm(), 0, 1e-6);
}

// A slave without a drive to speak of bounces off an undamped surface with the speed of its arrival. The peak
// of an impact at v under a constant push F is F + sqrt(F^2 + K m v^2).
TEST(Slave, BouncesOffAnUndampedContactAsAFreeMass) {
  for (const double stiffness : {1e4, 3e4, 1e5}) {
    SlaveSettings s;
    s.natural_frequency_hz = 0.1, s.damping_ratio = 0.05, s.contact_stiffness_N_per_m = stiffness;
    s.contact_damping_Ns_per_m = 0, s.steps_per_tick = 20;
    Slave slave(s, kTick_s, plane());
    double peak = 0, speed = 0;
    for (int tick = 0; tick < 3000 && !(peak > 0 && slave.state().clearance_m > 0); ++tick) {
      if (peak == 0) speed = -slave.state().velocity_W.y();
      peak = std::max(peak, slave.move({0, tick == 0 ? 0.02 : -2, 0}, tick * kTick_s).peak_force_N);
    }
    ASSERT_GT(speed, 0.05) << stiffness;
    EXPECT_NEAR(slave.state().velocity_W.y(), speed, 0.05 * speed) << stiffness;
    const double w = 2 * std::numbers::pi * s.natural_frequency_hz, push = s.mass_kg * w * w * 2;
    EXPECT_NEAR(peak, push + std::sqrt(push * push + stiffness * s.mass_kg * speed * speed), 0.01 * peak);
  }
}

// A surface that rises into a ball at rest pushes it, with the damper against its own speed.
TEST(Slave, IsPushedByASurfaceThatRises) {
  SlaveSettings s;
  s.contact_damping_Ns_per_m = 100;
  Slave slave(s, kTick_s, plane([](double t) { return t < 0.1 ? 0 : 0.05 * (t - 0.1); }));
  double first = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    const Slave::State& state = slave.move({0, 0.006, 0}, tick * kTick_s);
    if (first == 0 && state.peak_force_N > 0) first = state.peak_force_N;
  }
  // The surface reaches the ball with 0.05 m/s: the first force is that of the damper, 5 N, and little more.
  EXPECT_GT(first, 5);
  EXPECT_LT(first, 10);
  EXPECT_GT(slave.state().position_W.y(), 0.045);
}

// A scene that is known at the times of a camera stands, and then jumps. The spring is then loaded by the
// jump; the damper acts only on the speed of the slave. So the force does not depend on the steps.
TEST(Slave, NoDamperActsOverAJumpOfTheSurface) {
  constexpr double kJump_m = 0.003, kFrame_s = 0.0335;
  for (const int steps : {10, 20, 80}) {
    SlaveSettings s;
    s.steps_per_tick = steps;
    const auto frame_s = [](double t) { return kFrame_s * std::floor(t / kFrame_s); };
    SlaveScene scene = plane([&](double t) { return frame_s(t) >= 15 * kFrame_s ? kJump_m : 0.0; });
    scene.surface_time_s = frame_s;
    Slave slave(s, kTick_s, scene);
    double resting_N = 0, peak_N = 0;
    for (int tick = 0; tick < 600; ++tick) {
      const double t = tick * kTick_s;
      const Slave::State& state = slave.move({0, 0.004, 0}, t);
      (t < 15 * kFrame_s ? resting_N : peak_N) = std::max(t < 15 * kFrame_s ? 0 : peak_N, state.peak_force_N);
    }
    EXPECT_NEAR(resting_N, 1.852, 0.001) << steps;  // drive and contact in series, 1 mm
    EXPECT_NEAR(peak_N, resting_N + s.contact_stiffness_N_per_m * kJump_m, 0.5) << steps;
  }
}

// A ball that is too far away to touch does not ask for the distance in the tick of the jump.
TEST(Slave, AJumpFromFarAwayHasNoSpeedEither) {
  SlaveSettings s;
  const auto frame_s = [](double t) { return 0.1 * std::floor(t / 0.1); };
  SlaveScene scene = plane([&](double t) { return frame_s(t) > 0.15 ? 0.021 : 0.0; });
  scene.surface_time_s = frame_s;
  Slave slave(s, kTick_s, scene);
  double peak_N = 0;
  for (int tick = 0; tick < 250; ++tick)
    peak_N = std::max(peak_N, slave.move({0, 0.025, 0}, tick * kTick_s).peak_force_N);
  EXPECT_NEAR(peak_N, s.contact_stiffness_N_per_m * 0.001, 1);
}

// The distance of a surface may be known without its normal. The force is then not known.
TEST(Slave, DoesNotKnowAForceWithoutANormal) {
  SlaveScene scene = plane();
  scene.normal = nothing().normal;
  Slave slave({}, kTick_s, scene);
  slave.move({0, 0.01, 0}, 0);
  EXPECT_TRUE(slave.move({0, 0.01, 0}, kTick_s).is_force_known);
  for (int tick = 2; tick < 1000; ++tick) slave.move({0, -0.01, 0}, tick * kTick_s);
  EXPECT_LT(slave.state().clearance_m, -0.014);
  EXPECT_FALSE(slave.state().is_force_known);
  EXPECT_EQ(slave.state().force_N, Vec3::Zero());
  for (int tick = 1000; tick < 2000; ++tick) slave.move({0, 0.01, 0}, tick * kTick_s);
  EXPECT_TRUE(slave.state().is_force_known);
}

TEST(Slave, NeedsMoreStepsForAStifferContact) {
  SlaveSettings s;
  EXPECT_EQ(validate(s), "");
  s.contact_stiffness_N_per_m = 1e6, s.mass_kg = 0.1;
  const std::string refusal = validate(s);
  EXPECT_EQ(refusal.find("steps_per_tick = 10: expected "), 0u) << refusal;
  const int least = std::stoi(refusal.substr(refusal.find("expected ") + 9));
  s.steps_per_tick = least - 1;
  EXPECT_NE(validate(s), "");
  s.steps_per_tick = least;
  EXPECT_EQ(validate(s), "");
}

// Far from the scene, the distance is asked at the end of each tick only. A surface that comes fast is
// noticed.
TEST(Slave, AsksForTheDistanceInEveryStepOnlyNearTheScene) {
  int asked = 0;
  const auto height_m = [](double t) { return t < 0.5 ? 0 : 5 * (t - 0.5); };
  const SlaveScene ground = plane(height_m);
  const SlaveScene counted{[&](const Vec3& p, double t) { return ++asked, ground.signed_distance(p, t); },
                           ground.normal};
  Slave slave({}, kTick_s, counted);
  for (int tick = 0; tick <= 500; ++tick) slave.move({0, 0.1, 0}, tick * kTick_s);
  EXPECT_EQ(asked, 501);
  int first_ms = 0;
  for (int tick = 501; tick <= 530 && first_ms == 0; ++tick)
    if (slave.move({0, 0.1, 0}, tick * kTick_s).peak_force_N > 0) first_ms = tick;
  EXPECT_EQ(first_ms, 520);  // 95 mm at 5 m/s
}

// The error of the registration of a slave: its size, its directions, and that it belongs to the key.

constexpr int kDraws = 2000;

NoiseKey key(int replicate) {
  return {7, 0, static_cast<std::uint64_t>(replicate)};
}

TEST(RegistrationError, HasTheSizeThatIsAskedFor) {
  const Vec3 p(0.1, -0.2, 0.3);
  EXPECT_EQ(registration_of({}, key(3)) * p, p);
  for (int i = 0; i < 20; ++i) {
    const RigidTransform X = registration_of({0.004, 2}, key(i));
    EXPECT_NEAR(X.translation().norm(), 0.004, 1e-15);
    EXPECT_NEAR(rotation_vector(Eigen::Quaterniond(X.linear())).norm(), 2 * kRadiansPerDegree, 1e-12);
    EXPECT_LT((registration_of({0.008, 2}, key(i)).translation() - 2 * X.translation()).norm(), 1e-15)
        << "a larger error has the same direction";
  }
}

// The axis of the rotation goes through the centre, so a point at its distance d moves by 2 d sin(a / 2),
// where d is the distance from the axis. Without an offset the centre stays.
TEST(RegistrationError, TurnsAboutItsCentre) {
  const Vec3 centre(0.5, -0.1, 0.3);
  double largest_m = 0;
  for (int i = 0; i < 200; ++i) {
    const RigidTransform X = registration_of({0.004, 2, centre}, key(i));
    const RigidTransform about_origin = registration_of({0.004, 2}, key(i));
    EXPECT_TRUE(X.linear().isApprox(about_origin.linear(), 0)) << "the centre changes no direction";
    EXPECT_NEAR((X * centre - centre - about_origin.translation()).norm(), 0, 1e-15);
    const RigidTransform turn = registration_of({0, 2, centre}, key(i));
    largest_m = std::max(largest_m, (turn * Vec3::Zero()).norm());
  }
  const double bound_m = 2 * centre.norm() * std::sin(kRadiansPerDegree);
  EXPECT_LE(largest_m, bound_m + 1e-12);
  EXPECT_GT(largest_m, 0.99 * bound_m);
}

// The mean of n unit vectors that are uniform on the sphere has the length 1 / sqrt(n), and the mean of their
// products is a third of the identity. A direction of every run would not be random.
TEST(RegistrationError, DirectionsAreUniformAndIndependent) {
  Vec3 offsets = Vec3::Zero(), axes = Vec3::Zero();
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  double products = 0;
  for (int i = 0; i < kDraws; ++i) {
    const RigidTransform X = registration_of({1, 10}, key(i));
    const Vec3 axis = rotation_vector(Eigen::Quaterniond(X.linear())).normalized();
    offsets += X.translation(), axes += axis, products += axis.dot(X.translation());
    spread += X.translation() * X.translation().transpose();
  }
  const double allowed = 4 / std::sqrt(kDraws);
  EXPECT_LT(offsets.norm() / kDraws, allowed);
  EXPECT_LT(axes.norm() / kDraws, allowed);
  EXPECT_LT(std::abs(products) / kDraws, allowed);
  EXPECT_LT((spread / kDraws - Eigen::Matrix3d::Identity() / 3).norm(), allowed);
}

// The runs of one replicate of a sweep have the same error, so that its cells are compared in pairs.
TEST(RegistrationError, BelongsToSeedAndReplicateAndIsTheSameInEveryCellOfASweep) {
  const RegistrationError error{0.01, 5};
  const RigidTransform X = registration_of(error, {7, 0, 3});
  EXPECT_TRUE(X.isApprox(registration_of(error, {7, 0, 3}), 0));
  EXPECT_TRUE(X.isApprox(registration_of(error, {7, 12, 3}), 0)) << "another cell";
  EXPECT_FALSE(X.isApprox(registration_of(error, {7, 0, 4}), 0.001)) << "another replicate";
  EXPECT_FALSE(X.isApprox(registration_of(error, {8, 0, 3}), 0.001)) << "another seed";
}

}  // namespace
}  // namespace remote_touch::slave_test
