// The contract of QuadraticProgram: accuracy, inputs that must not matter, small cases worked out by hand,
// elastic use. program_proof_test.cpp shows that its answers are right in general.

#include "core/dissertation/tool_motion/motion_program.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "runners/evaluation/contract/allocation_counter.h"
#include "tests/core/dissertation/tool_motion/program_problems.h"
#include "tests/support/box_tool.h"

namespace remote_touch::quadratic_program_test {
namespace {

using namespace programs;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// --- accuracy ---

TEST(QuadraticProgram, SmallViolationsCount) {
  QuadraticProgram<6> program(2);
  program.add(Vector<6>::Unit(0), 2e-13);
  program.add(Vector<6>::Unit(1), 0.5);
  const ProgramResult<6> result = program.nearest(Vector<6>::Unit(1));
  EXPECT_EQ(result.y[0], 2e-13);
  EXPECT_EQ(result.y[1], 1);
}

// Walls that meet at a millionth of a radian. The corner is far away, where the rounding of a step is a
// million times larger.
TEST(QuadraticProgram, SharpWedgesHoldTheirRows) {
  Random random(11);
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector<6> wall = vector<6>(random).normalized(), middle = vector<6>(random);
    Problem<6> p;
    p.target = vector<6>(random);
    for (int j = 0; j < 8; ++j) {
      const Vector<6> row = (j % 2 == 0 ? 1 : -1) * wall + 1e-6 * vector<6>(random);
      p.add(row, row.dot(middle));
    }
    const ProgramResult<6> result = p.program().nearest(p.target);
    if (result.status != ProgramStatus::optimal) continue;
    ++found;
    const double scale = std::max(1.0, result.y.cwiseAbs().maxCoeff());
    EXPECT_LT(p.violation(result.y), 1e-12 * scale) << i;
    for (int j = 0; j < result.active_count; ++j) {
      const auto k = static_cast<std::size_t>(result.active[j]);
      EXPECT_LT(std::abs(p.bounds[k] - p.rows[k].dot(result.y)), 1e-13 * scale) << i;
    }
  }
  EXPECT_GT(found, 1990);
}

// --- what must not matter ---

TEST(QuadraticProgram, OrderAndLengthsOfRowsDoNotMatter) {
  Random random(5);
  for (int i = 0; i < 500; ++i) {
    const Problem<6> p = problem<6>(Kind::fulfillable, 40, random);
    const Vector<6> y = p.program().nearest(p.target).y;
    std::vector<std::size_t> order(p.rows.size());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random);
    Problem<6> other, doubled = p;
    for (const std::size_t j : order) {
      const double length = std::pow(10, between(random, -150, 150));
      other.add(length * p.rows[j], length * p.bounds[j]);
    }
    EXPECT_LT((other.program().nearest(p.target).y - y).norm(), 1e-12) << i;
    for (std::size_t j = 0; j < p.rows.size(); ++j) doubled.rows[j] *= 4, doubled.bounds[j] *= 4;
    EXPECT_EQ(doubled.program().nearest(p.target).y, y) << "powers of two round nothing";
  }
}

TEST(QuadraticProgram, SizeOfTheProblemDoesNotMatter) {
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    Problem<6> p = problem<6>(kKinds[i % 9], 20, random);
    const ProgramResult<6> whole = p.program().nearest(p.target);
    const double size = std::ldexp(1, count_of(random, -60, 60));
    for (double& bound : p.bounds) bound *= size;
    const ProgramResult<6> scaled = p.program().nearest(size * p.target);
    EXPECT_EQ(scaled.status, whole.status);
    EXPECT_EQ(scaled.y, size * whole.y) << i;
  }
}

// --- small cases worked out by hand ---

Vector<6> axis(int k, double value = 1) {
  return value * Vector<6>::Unit(k);
}

TEST(QuadraticProgram, TheTargetIsTheAnswerIfThereAreNoRows) {
  Random random(7);
  const Vector<6> target = vector<6>(random);
  for (const int capacity : {0, 5}) {
    const ProgramResult<6> result = QuadraticProgram<6>(capacity).nearest(target);
    EXPECT_EQ(result.status, ProgramStatus::optimal);
    EXPECT_EQ(result.y, target);
    EXPECT_EQ(result.active_count, 0);
  }
}

TEST(QuadraticProgram, MultipliersBelongToTheRowsAsGiven) {
  QuadraticProgram<6> program(3);
  program.add(axis(3), -1);
  program.add(axis(0, 4), 8);  // y0 >= 2
  program.add(axis(1, 0.5), 1.5);
  const ProgramResult<6> result = program.nearest(axis(0));
  EXPECT_EQ(result.y, axis(0, 2) + axis(1, 3));
  ASSERT_EQ(result.active_count, 2);
  EXPECT_EQ(result.active[0], 2);  // violated most: by 3
  EXPECT_EQ(result.multiplier[0], 6);
  EXPECT_EQ(result.active[1], 1);
  EXPECT_EQ(result.multiplier[1], 0.25);
}

TEST(QuadraticProgram, ZeroRowsHoldAlwaysOrNever) {
  for (const double bound : {-1.0, 0.0, 1e-300, 1.0}) {
    QuadraticProgram<6> program(2);
    EXPECT_TRUE(program.add(Vector<6>::Zero(), bound));
    EXPECT_TRUE(program.add(axis(2), 1));
    const ProgramResult<6> result = program.nearest(Vector<6>::Zero());
    EXPECT_EQ(result.status, bound > 0 ? ProgramStatus::infeasible : ProgramStatus::optimal) << bound;
    if (bound <= 0) {
      EXPECT_EQ(result.y, axis(2));
      EXPECT_EQ(result.active[0], 1);
    }
  }
}

TEST(QuadraticProgram, RefusesRowsThatAreNotFiniteOrHaveNoRoom) {
  QuadraticProgram<6> program(1);
  for (const double bad : {std::nan(""), kInfinite, -kInfinite}) {
    EXPECT_FALSE(program.add(axis(4, bad), 0));
    EXPECT_FALSE(program.add(axis(4), bad));
  }
  EXPECT_EQ(program.size(), 0);
  EXPECT_TRUE(program.add(axis(4), 1));
  EXPECT_FALSE(program.add(axis(5), 1));
  EXPECT_EQ(program.nearest(Vector<6>::Zero()).y, axis(4));
  program.clear();
  EXPECT_EQ(program.size(), 0);
  EXPECT_EQ(program.nearest(Vector<6>::Zero()).y, Vector<6>::Zero());
  EXPECT_TRUE(program.add(axis(5), 1));
  EXPECT_EQ(program.nearest(Vector<6>::Zero()).y, axis(5));
}

// add_all() gives the bits of adding the rows one after the other. If one row cannot be used, it adds none.
TEST(QuadraticProgram, AddingAllRowsAtOnceEqualsAddingEachRow) {
  Random random(12);
  for (const int count : {1, 2, 3, 8, 21, 40}) {
    const Problem<6> p = problem<6>(Kind::fulfillable, count, random);
    double columns[6][42] = {}, bounds[42] = {};
    for (std::size_t i = 0; i < p.rows.size(); ++i) {
      for (int k = 0; k < 6; ++k) columns[k][i] = p.rows[i][k];
      bounds[i] = p.bounds[i];
    }
    const auto all_at_once = [&](QuadraticProgram<6>& program) {
      return program.add_all({columns[0], columns[1], columns[2], columns[3], columns[4], columns[5]}, bounds,
                             static_cast<int>(p.rows.size()));
    };
    QuadraticProgram<6> program(42);
    ASSERT_TRUE(all_at_once(program)) << count;
    EXPECT_EQ(program.size(), static_cast<int>(p.rows.size()));
    EXPECT_EQ(program.nearest(p.target).y, p.program().nearest(p.target).y) << count;
    for (const double bad : {std::nan(""), kInfinite, 1e200}) {
      columns[3][p.rows.size() - 1] = bad;
      program.clear();
      EXPECT_FALSE(all_at_once(program)) << bad;
      EXPECT_EQ(program.size(), 0);
      EXPECT_EQ(program.nearest(p.target).y, p.target);
    }
  }
}

TEST(QuadraticProgram, ATargetThatIsNotFiniteOrTooLargeStalls) {
  QuadraticProgram<6> program(1);
  program.add(axis(4), 1);
  for (const double bad : {std::nan(""), kInfinite, -kInfinite, 1e160}) {
    const ProgramResult<6> result = program.nearest(axis(0, bad));
    EXPECT_EQ(result.status, ProgramStatus::stalled);
    EXPECT_EQ(result.y, Vector<6>::Zero());
  }
}

TEST(QuadraticProgram, ExtremeNumbersEndInAStatus) {
  Random random(8);
  for (int i = 0; i < 2000; ++i) {
    QuadraticProgram<6> program(20);
    const auto wild = [&] { return normal(random) * std::pow(10, between(random, -307, 307)); };
    for (int j = 0; j < 20; ++j) program.add(Vector<6>::NullaryExpr([&] { return wild(); }), wild());
    const Vector<6> target = Vector<6>::NullaryExpr([&] { return wild(); });
    const ProgramResult<6> result = program.nearest(target);
    EXPECT_TRUE(result.y.allFinite()) << i;
    EXPECT_LE(result.iterations, 8 * 26 + 1);
  }
}

TEST(QuadraticProgram, ASolutionAllocatesNothing) {
  Random random(9);
  const Problem<6> p = problem<6>(Kind::fulfillable, 100, random);
  QuadraticProgram<6> program = p.program();
  const std::size_t before = allocation_count();
  double sum = program.nearest(p.target).y.sum();
  program.clear();
  program.add(p.rows[0], p.bounds[0]);
  sum += program.nearest(p.target).y.sum();
  EXPECT_EQ(allocation_count(), before);
  EXPECT_TRUE(std::isfinite(sum));
}

// --- elastic use: a tool in a wedge that closes ---

// Two walls such as y0 >= 1 and -y0 >= 1 have no answer. One more variable, z >= 0, lets all walls give way
// by kappa z. Its target is -w, so it stays 0 as long as the walls push by less than w / kappa.
struct Elastic {
  double kappa = 1, w = 10;
  ProgramResult<7> nearest(const std::vector<std::pair<Vector<6>, double>>& rows, const Vector<6>& target) {
    QuadraticProgram<7> program(10);
    Vector<7> row = Vector<7>::Unit(6), t;
    program.add(row, 0);
    for (const auto& [r, bound] : rows) {
      row << r, kappa;
      program.add(row, bound);
    }
    t << target, -w;
    return program.nearest(t);
  }
};

TEST(QuadraticProgram, OneSlackLetsAWedgeGiveWayAsLittleAsItCan) {
  const Vector<6> target = axis(0, 0.3) + axis(1, -2);
  for (const double shut : {1.0, 0.01, 0.0}) {
    const ProgramResult<7> result = Elastic().nearest({{axis(0), shut}, {axis(0, -1), shut}}, target);
    ASSERT_EQ(result.status, ProgramStatus::optimal);
    // The answer lies half way between the walls and violates each by as much. It is free along them.
    EXPECT_NEAR(result.y[0], 0, 1e-14);
    EXPECT_EQ(result.y[1], -2);
    EXPECT_NEAR(result.y[6], shut, 1e-14);
  }
}

TEST(QuadraticProgram, TheSlackIsZeroWhereItIsNotNeeded) {
  Random random(10);
  int used = 0;
  for (int i = 0; i < 500; ++i) {
    std::vector<std::pair<Vector<6>, double>> rows;
    QuadraticProgram<6> hard(8);
    for (int j = 0; j < 8; ++j) {
      rows.push_back({vector<6>(random).normalized(), -0.3 * std::abs(normal(random))});
      hard.add(rows.back().first, rows.back().second);
    }
    const Vector<6> target = vector<6>(random);
    const ProgramResult<6> exact = hard.nearest(target);
    double force = 0;
    for (int j = 0; j < exact.active_count; ++j) force += exact.multiplier[j];
    const ProgramResult<7> result = Elastic().nearest(rows, target);
    ASSERT_EQ(result.status, ProgramStatus::optimal);
    if (force < 9.99) {
      EXPECT_LT((result.y.head<6>() - exact.y).norm(), 1e-12) << i;
      EXPECT_LT(std::abs(result.y[6]), 1e-13) << i;
    } else {
      ++used;
    }
  }
  EXPECT_LT(used, 50);
}

}  // namespace
}  // namespace remote_touch::quadratic_program_test

namespace remote_touch::motion_program_test {
namespace {

const auto kTool = scenes::box_tool({0.02, 0.005, 0.01});

Vector6 desired(const Vec3& a, const Vec3& alpha = Vec3::Zero()) {
  Vector6 both;
  both << a, alpha;
  return both;
}

double gap_speed(const ToolContact& c, const Vector6& a_g) {  // the left side of (6.3)
  return c.n_T.dot(a_g.head<3>()) + c.r_T.cross(c.n_T).dot(a_g.tail<3>());
}

TEST(MotionProgram, GrantsTheDesiredMotionIfThereAreNoContacts) {
  MotionProgram program({}, *kTool);
  const Vector6 wanted = desired({1e-3, -2e-3, 5e-4}, {0.01, 0, -0.02});
  const ConstrainedMotion motion = program.solve(wanted, {});
  EXPECT_LT((motion.a_g - wanted).norm(), 1e-15);
  EXPECT_EQ(motion.active_count, 0);
}

// A contact below the centre stops the downward motion and leaves the rest of the motion.
TEST(MotionProgram, ACentralContactTakesOnlyTheFall) {
  MotionProgram program({}, *kTool);
  const std::vector<ToolContact> contacts = {{{0, -0.005, 0}, Vec3::UnitY(), 0, 1}};
  const ConstrainedMotion motion = program.solve(desired({1e-3, -2e-3, 0}), contacts);
  EXPECT_LT((motion.a_g - desired({1e-3, 0, 0})).norm(), 1e-12);
  EXPECT_EQ(motion.active_count, 1);
  EXPECT_NEAR(motion.push_T.y(), 2e-3, 1e-12);
  EXPECT_GT(motion.side, 0);
}

// The tool tips over an off-centre point: Gauss' principle by hand. The row is (n, r x n), M = diag(1, I),
// and a = wish + M^-1 row^T lambda, lambda = -row.wish / (row M^-1 row^T).
TEST(MotionProgram, AnOffCentreContactTipsTheTool) {
  MotionProgram program({}, *kTool);
  const std::vector<ToolContact> contacts = {{{0.02, -0.005, 0}, Vec3::UnitY(), 0, 1}};
  const Vec3 lever = contacts[0].r_T.cross(contacts[0].n_T);
  const Vec3 rotated = kTool->inertia_m2.inverse() * lever;
  const double lambda = 2e-3 / (1 + lever.dot(rotated));
  const ConstrainedMotion motion = program.solve(desired({0, -2e-3, 0}), contacts);
  EXPECT_LT((motion.a_g - desired({0, -2e-3 + lambda, 0}, lambda * rotated)).norm(), 1e-12);
  EXPECT_NEAR(gap_speed(contacts[0], motion.a_g), 0, 1e-14);
}

TEST(MotionProgram, PenetrationIsResolvedByItsDepth) {
  MotionProgram program({}, *kTool);
  const std::vector<ToolContact> contacts = {{{-0.02, -0.005, 0}, Vec3::UnitY(), 3e-4, 1},
                                             {{0.02, -0.005, 0}, Vec3::UnitY(), 3e-4, 1},
                                             {{0, 0.005, 0}, -Vec3::UnitY(), -1e-3, 1}};
  const ConstrainedMotion motion = program.solve(Vector6::Zero(), contacts);
  EXPECT_LT((motion.a_g - desired({0, 3e-4, 0})).norm(), 1e-12);
  EXPECT_FALSE(motion.is_relaxed);
}

// Two walls close in by 0.4 mm each. No motion resolves both, so each is loosened by as much, and the tool
// still follows the device along the wedge.
TEST(MotionProgram, AWedgeIsLoosenedAndTheToolFollowsAlongIt) {
  MotionProgram program({}, *kTool);
  const std::vector<ToolContact> contacts = {{{0.02, -0.005, 0}, Vec3::UnitY(), 4e-4, 1},
                                             {{-0.02, -0.005, 0}, Vec3::UnitY(), 4e-4, 1},
                                             {{0.02, 0.005, 0}, -Vec3::UnitY(), 4e-4, 1},
                                             {{-0.02, 0.005, 0}, -Vec3::UnitY(), 4e-4, 1}};
  const ConstrainedMotion motion = program.solve(desired({1e-3, -2e-3, 5e-4}), contacts);
  EXPECT_TRUE(motion.is_relaxed);
  EXPECT_FALSE(motion.failed);
  EXPECT_NEAR(motion.a_g[0], 1e-3, 1e-9);
  EXPECT_NEAR(motion.a_g[2], 5e-4, 1e-9);
  EXPECT_NEAR(motion.a_g[1], 0, 1e-6);
}

// A desired motion too long for the program has no result.
TEST(MotionProgram, AProgramWithoutAResultHasFailedAndMovesNothing) {
  MotionProgram program({}, *kTool);
  const std::vector<ToolContact> contacts = {{{0, -0.005, 0}, Vec3::UnitY(), 0, 1}};
  const ConstrainedMotion motion = program.solve(desired({0, -1e200, 0}), contacts);
  EXPECT_TRUE(motion.failed);
  EXPECT_TRUE(motion.a_g.isZero(0));
  EXPECT_FALSE(program.solve(desired({0, -2e-3, 0}), contacts).failed);
}

TEST(MotionProgram, NanContactsAreLeftOut) {
  MotionProgram program({}, *kTool);
  std::vector<ToolContact> contacts = {{{0, -0.005, 0}, Vec3::Constant(std::nan("")), 0, 1},
                                       {{0, -0.005, 0}, Vec3::UnitY(), std::nan(""), 1},
                                       {{0, -0.005, 0}, Vec3::UnitY(), 0, 1}};
  const ConstrainedMotion motion = program.solve(desired({1e-3, -2e-3, 0}), contacts);
  EXPECT_LT((motion.a_g - desired({1e-3, 0, 0})).norm(), 1e-12);
  EXPECT_NEAR(motion.push_T.y(), 2e-3, 1e-12);  // the multiplier belongs to the last of the three
}

// The coupling turns the blocked part of the desired motion into a wrench. A single contact can exert this
// wrench: a force f n and the torque f r x n. It cannot if the metric is the inertia of the tool.
TEST(MotionProgram, CouplingWrenchOnACornerIsThatOfTheContact) {
  const std::vector<ToolContact> contacts = {{{0.02, -0.005, 0.004}, Vec3(0.1, 1, 0.2).normalized(), 0, 1}};
  const Vector6 wish = desired({1e-4, -2e-3, 0}, {0.01, 0, -0.02});
  const auto torque_error = [&](MotionMetric metric) {
    ToolParameters p;
    p.motion_metric = metric;
    MotionProgram program(p, *kTool);
    const Vector6 left = program.solve(wish, contacts).a_g - wish;
    const double squared_m2 = p.gyration_radius_m * p.gyration_radius_m,
                 force = left.head<3>().dot(contacts[0].n_T);
    const Vec3 of_contact = force * contacts[0].r_T.cross(contacts[0].n_T);
    EXPECT_GT(force, 1e-4);
    EXPECT_LT((left.head<3>() - force * contacts[0].n_T).norm(), 1e-12);
    return (squared_m2 * left.tail<3>() - of_contact).norm() / of_contact.norm();
  };
  EXPECT_LT(torque_error(MotionMetric::coupling), 1e-9);
  EXPECT_GT(torque_error(MotionMetric::tool), 0.5);
}

}  // namespace
}  // namespace remote_touch::motion_program_test
