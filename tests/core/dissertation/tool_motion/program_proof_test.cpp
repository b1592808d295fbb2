// Answers of QuadraticProgram to thousands of problems, proved and compared with other solvers; its accuracy,
// what it refuses, and small cases worked out by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/dissertation/tool_motion/motion_program.h"
#include "tests/core/dissertation/tool_motion/program_peers.h"
#ifdef REMOTE_TOUCH_NLOPT
#include "tests/core/dissertation/tool_motion/nlopt_program.h"
#endif

namespace remote_touch::program_proof_test {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// --- problems drawn at random ---

using peers::Problem;
template <int N>
using Vector = peers::Vector<N>;
using Random = std::mt19937_64;

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

// Returns a random problem of about unit size whose rows have lengths from 1/1000 to 1000.
template <int N>
Problem<N> problem(Kind kind, int count, Random& random) {
  Problem<N> p;
  const Vector<N> middle = 0.5 * vector<N>(random);
  p.target = vector<N>(random);
  const double curved = count_of(random, 0, 1) * 0.05, angle = std::pow(10, between(random, -3, -1));
  const Vector<N> wall = vector<N>(random).normalized();
  while (p.size() < count) {
    Vector<N> row = vector<N>(random);
    double slack = 0;
    switch (kind) {
      case Kind::fulfillable:
      case Kind::duplicates:
        slack = std::abs(normal(random));
        break;
      case Kind::any:
        slack = 1 + normal(random);
        break;
      case Kind::wedge:
        row = (p.size() % 2 == 0 ? 1 : -1) * wall + angle * row;
        slack = 0.1 * angle * std::abs(normal(random));
        break;
      case Kind::patch:
        row = contact<N>(random, curved);
        slack = 0.1 * std::abs(normal(random));
        break;
      default:
        break;
    }
    p.add(row, row.dot(middle) - slack);
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

// Checks the conditions of Karush, Kuhn and Tucker, which are necessary and sufficient for the nearest point.
template <int N>
void expect_proof(const Problem<N>& p, const ProgramResult<N>& result) {
  EXPECT_LT(p.violation(result.y), 1e-12);
  ASSERT_LE(result.active_count, N);
  Vector<N> pull = p.target - result.y;
  double max = 1;
  for (int j = 0; j < result.active_count; ++j) {
    const auto i = static_cast<std::size_t>(result.active[j]);
    ASSERT_LT(i, p.rows.size());
    EXPECT_GE(result.multiplier[j], 0);
    EXPECT_LT(std::abs(p.bounds[i] - p.rows[i].dot(result.y)) / p.rows[i].norm(), 1e-12);
    pull += result.multiplier[j] * p.rows[i];
    max = std::max(max, result.multiplier[j] * p.rows[i].norm());
  }
  EXPECT_LT(pull.norm(), 1e-12 * max);
}

// --- proofs ---

template <int N>
bool expect_right(const Problem<N>& p) {
  const ProgramResult<N> result = p.program().nearest(p.target);
  EXPECT_NE(result.status, ProgramStatus::stalled);
  const bool found = result.status == ProgramStatus::optimal;
  if (found)
    expect_proof(p, result);
  else
    EXPECT_LT(peers::min_distance(p).gap, 1e-7) << "no proof that there is no answer";
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

// --- comparison with another library ---

#ifdef REMOTE_TOUCH_NLOPT
template <int N>
void expect_no_better_answer_of_nlopt() {
  Random random(200 + N);
  int compared = 0, agreed = 0;
  for (int i = 0; i < 10000; ++i) {
    Problem<N> p = problem<N>(kKinds[i % 9], count_of(random, 1, 30), random);
    // SLSQP does not normalise rows.
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
    // A point of SLSQP that fulfils the rows is not nearer than ours, whatever its accuracy. A point that
    // violates them may be nearer by the multipliers times its violation.
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
// small coordinates, make the cone narrow, so that many rows are added too early.
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

// Powers of two round nothing, so the answers have equal bits.
TEST(QuadraticProgram, ScalesOfRowsAndOfTheProblemDoNotMatter) {
  Random random(6);
  for (int i = 0; i < 500; ++i) {
    Problem<6> p = problem<6>(kKinds[i % 9], 20, random);
    const ProgramResult<6> whole = p.program().nearest(p.target);
    const double size = std::ldexp(1, count_of(random, -60, 60));
    for (std::size_t j = 0; j < p.rows.size(); ++j) {
      const double length = std::ldexp(1, count_of(random, -400, 400));
      p.rows[j] *= length, p.bounds[j] *= size * length;
    }
    const ProgramResult<6> scaled = p.program().nearest(size * p.target);
    EXPECT_EQ(scaled.status, whole.status);
    EXPECT_EQ(scaled.y, size * whole.y) << i;
  }
}

// --- small cases worked out by hand ---

Vector<6> axis(int k, double value = 1) {
  return value * Vector<6>::Unit(k);
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

}  // namespace
}  // namespace remote_touch::program_proof_test
