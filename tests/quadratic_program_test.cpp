#include "core/quadratic_program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "tests/allocation_counter.h"
#include "tests/program_peers.h"
#ifdef REMOTE_TOUCH_NLOPT
#include "tests/nlopt_program.h"
#endif

namespace remote_touch {
namespace {

using peers::Problem;
template <int N>
using Vector = peers::Vector<N>;
using Random = std::mt19937_64;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// --- problems ---

double normal(Random& random) {
  return std::normal_distribution<double>()(random);
}
double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
int count_of(Random& random, int low, int high) {
  return std::uniform_int_distribution<int>(low, high)(random);
}
template <int N>
Vector<N> vector(Random& random) {
  return Vector<N>::NullaryExpr([&] { return normal(random); });
}

enum class Kind {
  fulfillable,    // random rows around a point that fulfils them
  any,            // random bounds: many have no answer
  vertex,         // all rows through one point
  duplicates,     // rows that come again, longer or shorter
  equalities,     // antiparallel pairs that leave a plane
  contradiction,  // antiparallel pairs that leave nothing
  wedge,          // walls that meet at small angles
  patch,          // contacts (n, r x n) of a tool with a flat or slightly curved surface
  farkas          // one row against a combination of others
};
constexpr Kind kKinds[] = {Kind::fulfillable,   Kind::any,   Kind::vertex, Kind::duplicates, Kind::equalities,
                           Kind::contradiction, Kind::wedge, Kind::patch,  Kind::farkas};

template <int N>
Vector<N> contact(Random& random, double curved) {
  const Eigen::Vector3d n = Eigen::Vector3d(curved * normal(random), 1, curved * normal(random)).normalized();
  const Eigen::Vector3d r(between(random, -1, 1), 0.2, between(random, -1, 1));
  Vector<N> row = Vector<N>::Zero();
  row.template head<3>() = n;
  row.template segment<3>(3) = r.cross(n);
  return row;
}

// About unit size, with rows of lengths from 1/1000 to 1000.
template <int N>
Problem<N> problem(Kind kind, int count, Random& random) {
  Problem<N> p;
  const Vector<N> middle = 0.5 * vector<N>(random);
  p.target = vector<N>(random);
  const double curved = count_of(random, 0, 1) * 0.05, angle = std::pow(10, between(random, -3, -1));
  const Vector<N> wall = vector<N>(random).normalized();
  while (p.size() < count) {
    Vector<N> row = vector<N>(random);
    double room = 0;
    switch (kind) {
      case Kind::fulfillable:
      case Kind::duplicates:
        room = std::abs(normal(random));
        break;
      case Kind::any:
        room = 1 + normal(random);
        break;
      case Kind::wedge:
        row = (p.size() % 2 == 0 ? 1 : -1) * wall + angle * row;
        room = 0.1 * angle * std::abs(normal(random));
        break;
      case Kind::patch:
        row = contact<N>(random, curved);
        room = 0.1 * std::abs(normal(random));
        break;
      default:
        break;
    }
    p.add(row, row.dot(middle) - room);
    if (kind == Kind::duplicates)
      p.add(row, p.bounds.back()), p.add(3 * row, 3 * p.bounds[p.bounds.size() - 2]);
    if (kind == Kind::equalities && p.size() < N) p.add(-row, -p.bounds.back());
    if (kind == Kind::contradiction && p.size() == 1) p.add(-row, 1e-3 * row.norm() - p.bounds.back());
  }
  if (kind == Kind::farkas) {
    Vector<N> against = Vector<N>::Zero();
    double bound = 1e-3;
    for (std::size_t i = 0; i < static_cast<std::size_t>(std::min(count, N)); ++i) {
      const double weight = between(random, 0.1, 1);
      against -= weight * p.rows[i], bound -= weight * p.bounds[i];
    }
    p.add(against, bound);
  }
  for (std::size_t i = 0; i < p.rows.size(); ++i) {
    const double length = std::pow(10, between(random, -3, 3));
    p.rows[i] *= length, p.bounds[i] *= length;
  }
  return p;
}

// --- proofs ---

// Necessary and sufficient for the nearest point, whoever found it: Karush, Kuhn and Tucker.
template <int N>
void expect_proof(const Problem<N>& p, const ProgramResult<N>& result) {
  EXPECT_LT(p.violation(result.y), 1e-12);
  ASSERT_LE(result.active_count, N);
  Vector<N> pull = p.target - result.y;
  double largest = 1;
  for (int j = 0; j < result.active_count; ++j) {
    const auto i = static_cast<std::size_t>(result.active[j]);
    ASSERT_LT(i, p.rows.size());
    EXPECT_GE(result.multiplier[j], 0);
    EXPECT_LT(std::abs(p.bounds[i] - p.rows[i].dot(result.y)) / p.rows[i].norm(), 1e-12);
    pull += result.multiplier[j] * p.rows[i];
    largest = std::max(largest, result.multiplier[j] * p.rows[i].norm());
  }
  EXPECT_LT(pull.norm(), 1e-12 * largest);
}

template <int N>
bool expect_right(const Problem<N>& p) {
  const ProgramResult<N> result = p.program().nearest(p.target);
  EXPECT_NE(result.status, ProgramStatus::stalled);
  const bool found = result.status == ProgramStatus::optimal;
  if (found)
    expect_proof(p, result);
  else
    EXPECT_LT(peers::least_distance(p).gap, 1e-7) << "no proof that there is no answer";
  return found;
}

template <int N>
void expect_all_right() {
  Random random(N);
  int found = 0, infeasible = 0;
  for (int i = 0; i < 10000; ++i) {
    const Kind kind = kKinds[i % 9];
    const Problem<N> p = problem<N>(kind, i % 500 == 17 ? 256 : count_of(random, 1, 60), random);
    const bool is_optimal = expect_right(p);
    if (kind != Kind::any) {
      EXPECT_EQ(is_optimal, kind != Kind::contradiction && kind != Kind::farkas);
    }
    if (testing::Test::HasFailure()) FAIL() << "problem " << i << ", kind " << i % 9 << ", rows " << p.size();
    (is_optimal ? found : infeasible) += 1;
  }
  EXPECT_GT(found, 6000);
  EXPECT_GT(infeasible, 2200);
}

TEST(QuadraticProgram, ProvesTenThousandAnswersOfSixVariables) {
  expect_all_right<6>();
}
TEST(QuadraticProgram, ProvesTenThousandAnswersOfSevenVariables) {
  expect_all_right<7>();
}

// --- against others ---

template <int N>
void expect_the_best_of_all_subsets() {
  Random random(100 + N);
  int found = 0, infeasible = 0;
  for (int i = 0; i < 900; ++i) {
    const Problem<N> p = problem<N>(kKinds[i % 9], count_of(random, 1, 6), random);
    if (p.size() > 10) continue;
    const ProgramResult<N> result = p.program().nearest(p.target);
    const auto best = peers::nearest_of_all_subsets(p);
    ASSERT_EQ(result.status == ProgramStatus::optimal, best.has_value()) << i;
    (best ? found : infeasible) += 1;
    // Rows at small angles move a corner by their rounding over the angle.
    if (best) {
      ASSERT_LT((result.y - *best).norm(), kKinds[i % 9] == Kind::wedge ? 1e-8 : 1e-11) << i;
    }
  }
  EXPECT_GT(found, 400);
  EXPECT_GT(infeasible, 150);
}

TEST(QuadraticProgram, IsTheBestOfAllSubsets) {
  expect_the_best_of_all_subsets<6>();
  expect_the_best_of_all_subsets<7>();
}

#ifdef REMOTE_TOUCH_NLOPT
template <int N>
void expect_no_better_answer_of_nlopt() {
  Random random(200 + N);
  int compared = 0, agreed = 0;
  for (int i = 0; i < 10000; ++i) {
    Problem<N> p = problem<N>(kKinds[i % 9], count_of(random, 1, 30), random);
    // SLSQP looks at rows as they are given.
    for (std::size_t j = 0; j < p.rows.size(); ++j) {
      const double length = p.rows[j].norm();
      p.rows[j] /= length, p.bounds[j] /= length;
    }
    const ProgramResult<N> result = p.program().nearest(p.target);
    const Vector<N> theirs = peers::nlopt_nearest(p);
    if (result.status != ProgramStatus::optimal) {
      EXPECT_GT(p.violation(theirs), 1e-9) << i << ": NLopt fulfils what we call infeasible";
      continue;
    }
    // Whatever accuracy SLSQP reached, a point that fulfils the rows is not nearer than ours, but for what
    // the multipliers give for its violation.
    double force = 0;
    for (int j = 0; j < result.active_count; ++j) force += result.multiplier[j];
    const double ours = (result.y - p.target).squaredNorm() / 2,
                 their = (theirs - p.target).squaredNorm() / 2;
    EXPECT_LT(ours - their, 1e-12 * (1 + force) + force * std::max(0.0, p.violation(theirs))) << i;
    ++compared, agreed += (theirs - result.y).norm() < 1e-6;
  }
  EXPECT_GT(compared, 6000);
  EXPECT_GT(agreed, 0.999 * compared);
}
#endif

TEST(QuadraticProgram, NloptFindsNothingNearerInTwentyThousandProblems) {
#ifdef REMOTE_TOUCH_NLOPT
  expect_no_better_answer_of_nlopt<6>();
  expect_no_better_answer_of_nlopt<7>();
#else
  GTEST_SKIP() << "built without NLopt: libnlopt-dev is missing";
#endif
}

// --- rows that leave and come back ---

// Rows through the origin: y - target is the point of their cone nearest to -target. Short lever arms, three
// small coordinates, make the cone narrow, so that many rows are taken in too early.
Problem<6> cone_problem(Random& random) {
  Problem<6> p;
  p.target = vector<6>(random);
  for (int i = 0; i < 12; ++i) {
    Vector<6> row = vector<6>(random);
    row.tail<3>() *= 0.1;
    p.add(row.normalized(), 0);
  }
  return p;
}

TEST(QuadraticProgram, RowsThatLeftComeBackUnlikeInPublishedWilhelmsen) {
  Random random(3);
  int returned = 0, wrong = 0;
  for (int i = 0; i < 1000; ++i) {
    const Problem<6> p = cone_problem(random);
    Eigen::MatrixXd generators(6, p.size());
    for (int j = 0; j < p.size(); ++j) generators.col(j) = p.rows[static_cast<std::size_t>(j)];
    const peers::ConePoint whole = peers::nearest_of_cone(generators, -p.target);
    const peers::ConePoint lossy = peers::nearest_of_cone(generators, -p.target, false);
    ASSERT_LT(p.violation(p.target + whole.nearest), 1e-10);
    const ProgramResult<6> result = p.program().nearest(p.target);
    ASSERT_EQ(result.status, ProgramStatus::optimal);
    ASSERT_LT((result.y - p.target - whole.nearest).norm(), 1e-10);
    expect_proof(p, result);
    returned += whole.returned > 0;
    const double violation = p.violation(p.target + lossy.nearest);
    wrong += violation > 1e-6;
    if (violation > 1e-6) {
      EXPECT_GT(whole.returned, 0) << "the two differ in nothing else";
    }
  }
  EXPECT_GT(returned, 100);
  EXPECT_GT(wrong, 50) << "problems in which rows are violated for good";
}

// The row that is violated most at the target is needed at the end, and not in between.
TEST(QuadraticProgram, TheFirstRowLeavesAndComesBack) {
  Random random(4);
  int seen = 0;
  for (int i = 0; i < 1000; ++i) {
    const Problem<6> p = cone_problem(random);
    // Of the rows taken in one after the other, stopped by a program of the rows seen so far.
    Problem<6> part;
    part.target = p.target;
    Vector<6> y = p.target;
    bool left = false, back = false;
    while (p.violation(y) > 1e-12) {
      int worst = 0;
      for (int j = 1; j < p.size(); ++j)
        if (p.rows[static_cast<std::size_t>(j)].dot(y) < p.rows[static_cast<std::size_t>(worst)].dot(y))
          worst = j;
      ASSERT_LT(part.size(), 100) << "the same rows again and again";
      part.add(p.rows[static_cast<std::size_t>(worst)], 0);
      const ProgramResult<6> result = part.program().nearest(p.target);
      ASSERT_EQ(result.status, ProgramStatus::optimal);
      y = result.y;
      const bool holds = std::find(result.active, result.active + result.active_count, 0) !=
                         result.active + result.active_count;
      back = back || (left && holds), left = left || !holds;
    }
    const ProgramResult<6> result = p.program().nearest(p.target);
    ASSERT_LT((result.y - y).norm(), 1e-12);
    seen += back;
  }
  EXPECT_GT(seen, 50);
}

// --- accuracy ---

TEST(QuadraticProgram, SmallViolationsCount) {
  QuadraticProgram<6> program(2);
  program.add(Vector<6>::Unit(0), 2e-13);
  program.add(Vector<6>::Unit(1), 0.5);
  const ProgramResult<6> result = program.nearest(Vector<6>::Unit(1));
  EXPECT_EQ(result.y[0], 2e-13);
  EXPECT_EQ(result.y[1], 1);
}

// Walls that meet at a millionth of a radian: what a step rounds is a million times larger far away.
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

TEST(QuadraticProgram, WithoutRowsTheTargetIsTheAnswer) {
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

TEST(QuadraticProgram, NothingIsLeftAfterClear) {
  QuadraticProgram<6> program(20);
  for (int k = 0; k < 20; ++k) program.add(axis(k % 6), 1 + k);
  program.clear();
  program.add(axis(5), 1);
  EXPECT_EQ(program.nearest(Vector<6>::Zero()).y, axis(5));
}

TEST(QuadraticProgram, ATargetThatIsNoNumberStalls) {
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

// Two walls, y0 >= 1 and -y0 >= 1 say, have no answer. One variable more, z >= 0, lets all of them give way
// by kappa z; it is drawn to -w, so that it stays 0 as long as the walls push by less than w / kappa.
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
    // Half way between the walls, each violated by as much; free along them.
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
}  // namespace remote_touch
