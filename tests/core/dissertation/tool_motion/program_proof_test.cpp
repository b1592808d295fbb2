// Answers of QuadraticProgram to thousands of problems: proved, and compared with other ways to find them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/dissertation/tool_motion/motion_program.h"
#include "tests/core/dissertation/tool_motion/program_problems.h"
#ifdef REMOTE_TOUCH_NLOPT
#include "tests/core/dissertation/tool_motion/nlopt_program.h"
#endif

namespace remote_touch::program_proof_test {
namespace {

using namespace programs;

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

// --- comparison with other solvers ---

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
    // The rounding of rows at small angles moves a corner by the rounding divided by the angle.
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

// The row that is violated most at the target is active at the end, but not in between.
TEST(QuadraticProgram, TheFirstRowLeavesAndComesBack) {
  Random random(4);
  int seen = 0;
  for (int i = 0; i < 1000; ++i) {
    const Problem<6> p = cone_problem(random);
    // Adds the most violated row to a part of the problem, solves it, and repeats until no row is violated.
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

}  // namespace
}  // namespace remote_touch::program_proof_test
