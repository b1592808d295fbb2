#include "analysis/theory/sampled_wall.h"

#include <Eigen/Eigenvalues>
#include <limits>

namespace remote_touch {

namespace {

// Returns the matrix that maps position, velocity and held force to their values one tick later: the
// exponential of the motion, by its series for a sixteenth of the tick and four squarings.
Eigen::Matrix3d motion_of(const SampledWall& wall, double stiffness_N_per_m) {
  constexpr int kSquarings = 4, kTerms = 16;
  const double m = wall.mass_kg;
  Eigen::Matrix3d rate;
  rate << 0, 1, 0, -wall.spring_share * stiffness_N_per_m / m, -wall.damping_Ns_per_m / m, 1 / m, 0, 0, 0;
  rate *= wall.tick_s / (1 << kSquarings);
  Eigen::Matrix3d motion = Eigen::Matrix3d::Identity(), term = motion;
  for (int i = 1; i <= kTerms; ++i) term = (term * rate / i).eval(), motion += term;
  for (int i = 0; i < kSquarings; ++i) motion = (motion * motion).eval();
  return motion;
}

// The state is x, x', the positions of the last n ticks and the commands of the last d ticks, newest first.
bool is_stable(const SampledWall& wall, double stiffness_N_per_m) {
  constexpr double kRounding = 1e-12;
  const int n = wall.velocity_ticks, d = wall.delay_ticks, size = 2 + n + d;
  const double damper_N_per_m = wall.wall_damping_Ns_per_m / (n * wall.tick_s);
  Eigen::RowVectorXd command = Eigen::RowVectorXd::Zero(size);
  command[0] = -stiffness_N_per_m - damper_N_per_m, command[1 + n] = damper_N_per_m;
  const Eigen::MatrixXd now = Eigen::MatrixXd::Identity(size, size);
  const Eigen::RowVectorXd force = d == 0 ? command : Eigen::RowVectorXd(now.row(size - 1));
  const Eigen::Matrix3d motion = motion_of(wall, stiffness_N_per_m);
  Eigen::MatrixXd next = Eigen::MatrixXd::Zero(size, size);
  for (int i = 0; i < 2; ++i)
    next.row(i) = motion(i, 0) * now.row(0) + motion(i, 1) * now.row(1) + motion(i, 2) * force;
  next.row(2) = now.row(0);
  for (int i = 3; i < 2 + n; ++i) next.row(i) = now.row(i - 1);
  if (d > 0) next.row(2 + n) = command;
  for (int i = 3 + n; i < size; ++i) next.row(i) = now.row(i - 1);
  return Eigen::EigenSolver<Eigen::MatrixXd>(next, false).eigenvalues().cwiseAbs().maxCoeff() <=
         1 + kRounding;
}

}  // namespace

double wall_law_N_per_m(const SampledWall& wall) {
  return (wall.damping_Ns_per_m + wall.wall_damping_Ns_per_m) / ((0.5 + wall.delay_ticks) * wall.tick_s);
}

double exact_wall_limit_N_per_m(const SampledWall& wall) {
  constexpr double kStep = 1.02, kPrecision = 1e-9;
  const double law = wall_law_N_per_m(wall);
  double low = 0, high = 0.01 * law;
  while (is_stable(wall, high)) {
    low = high, high *= kStep;
    if (high > 100 * law) return std::numeric_limits<double>::infinity();
  }
  if (low == 0) return 0;
  while (high - low > kPrecision * high) {
    const double middle = 0.5 * (low + high);
    (is_stable(wall, middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace remote_touch
