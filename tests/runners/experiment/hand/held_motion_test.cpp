// The motion of a mass in a tick, with a held force and with dry friction: closed forms of the product
// against matrix exponentials, and its energies.
#include "runners/experiment/hand/simulated_hand.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace remote_touch::held_motion_test {
namespace {

// An oracle: matrix exponentials in long double. It shares no code and no formula with HeldForceStep.
namespace oracle {

using Real = long double;
static_assert(std::numeric_limits<Real>::digits >= 64, "the oracle must be finer than a double");

// State: x, x', the path p, p', and the force per mass. The motion is linear in the state.
using State = Eigen::Matrix<Real, 5, 1>;
using Matrix = Eigen::Matrix<Real, 5, 5>;

Matrix generator(const MassOnSpring& s) {
  const Real m = s.mass;
  Matrix a = Matrix::Zero();
  a(0, 1) = a(2, 3) = 1;
  a(1, 0) = -s.stiffness / m, a(1, 2) = s.stiffness / m;
  a(1, 1) = -(static_cast<Real>(s.path_damping) + s.ground_damping) / m, a(1, 3) = s.path_damping / m;
  a(1, 4) = 1;
  return a;
}

// Returns E = exp(A t) - 1, which keeps the digits of slow motions beside fast ones. Doubling: exp(2 A t) - 1
// = 2 E + E^2.
Matrix exponential_less_one(const Matrix& generator, Real t) {
  Matrix a = generator * t;
  int doublings = 0;
  while (a.cwiseAbs().maxCoeff() > 1 / Real(64)) a /= 2, ++doublings;
  Matrix e = Matrix::Zero(), term = Matrix::Identity();
  for (int n = 1; n <= 16; ++n) {
    term = (term * a / n).eval();
    e += term;
  }
  for (; doublings > 0; --doublings) e = (2 * e + e * e).eval();
  return e;
}

State change(const MassOnSpring& system, const State& start, Real t) {
  return exponential_less_one(generator(system), t) * start;
}

State after(const MassOnSpring& system, const State& start, Real t) {
  return start + change(system, start, t);
}

// Returns the integral of (q . state)^2 from 0 to t. It begins with Gauss-Legendre quadrature over a time in
// which the state hardly changes, and then doubles the time: G(2 t) = G(t) + exp(A t)^T G(t) exp(A t).
Real square_integral(const MassOnSpring& system, const State& start, const State& q, Real t) {
  const Matrix a = generator(system);
  int doublings = 0;
  Real short_time = t;
  while ((a * short_time).cwiseAbs().maxCoeff() > 1 / Real(64)) short_time /= 2, ++doublings;
  const Real node[] = {0.1834346424956498049L, 0.5255324099163289858L, 0.7966664774136267396L,
                       0.9602898564975362317L};
  const Real weight[] = {0.3626837833783619830L, 0.3137066458778872873L, 0.2223810344533744705L,
                         0.1012285362903762592L};
  Matrix sum = Matrix::Zero();
  for (int i = 0; i < 4; ++i)
    for (const int side : {-1, 1}) {
      const Real at = short_time * (1 + side * node[i]) / 2;
      const State row = q + exponential_less_one(a, at).transpose() * q;
      sum += weight[i] * short_time / 2 * row * row.transpose();
    }
  for (Real now = short_time; doublings > 0; --doublings, now *= 2) {
    const Matrix all = exponential_less_one(a, now) + Matrix::Identity();
    sum = (sum + all.transpose() * sum * all).eval();
  }
  return start.dot(sum * start);
}

}  // namespace oracle

using oracle::Real;

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double between(double low, double high) { return low + (high - low) * random_() / 4294967296.0; }
  double log_between(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  bool one_in(int n) { return random_() % static_cast<unsigned>(n) == 0; }
  Vec3 vector(double length) {
    std::normal_distribution<double> normal;
    return length * Vec3(normal(random_), normal(random_), normal(random_)).normalized();
  }

 private:
  std::mt19937 random_;
};

struct Case {
  MassOnSpring system;
  double duration_s = 0.001;
};

// The cases cover what the settings accept at 100 to 10000 ticks a second, for translation and rotation:
// sqrt(k / m) T up to 31.6 and (c / m) T up to 1e5. One in four has the critical damping; some have zeros.
Case draw_case(Draw& draw) {
  Case c;
  c.duration_s = draw.log_between(1e-4, 1e-2);
  c.system.mass = draw.log_between(1e-5, 100);
  const double per_s = 1 / c.duration_s;
  if (!draw.one_in(5)) c.system.stiffness = draw.log_between(1e-8, 1000) * c.system.mass * per_s * per_s;
  double damping = draw.log_between(1e-8, 1e5) * c.system.mass * per_s;
  if (draw.one_in(4)) damping = 2 * std::sqrt(c.system.stiffness * c.system.mass);
  if (draw.one_in(5)) damping = 0;
  const double share = draw.one_in(3) ? 1 : draw.one_in(2) ? 0 : draw.between(0, 1);
  c.system.path_damping = share * damping, c.system.ground_damping = (1 - share) * damping;
  return c;
}

// The largest |displacement| and |velocity| in [0, T], to which an error is compared.
struct Largest {
  Largest(const MassOnSpring& system, const oracle::State& start, double duration_s) {
    for (int i = 1; i <= 16; ++i) {
      const oracle::State s = oracle::after(system, start, static_cast<Real>(duration_s) * i / 16);
      displacement = std::max(displacement, std::abs(s(0) - start(0)));
      velocity = std::max(velocity, std::abs(s(1)));
    }
    velocity = std::max(velocity, std::abs(start(1)));
  }
  Real displacement = 0, velocity = 0;
};

// Each start has one quantity alone, so that every coefficient is compared by itself.
Real worst_error(const Case& c) {
  const HeldForceStep step(c.system, c.duration_s);
  HeldForceStep::Start starts[4];
  starts[0].velocity.x() = 1;
  starts[1].force.x() = c.system.mass;
  starts[2].apart.x() = 1;
  starts[3].path_velocity.x() = 1;
  Real worst = 0;
  for (const HeldForceStep::Start& start : starts) {
    oracle::State state;
    state << 0, start.velocity.x(), start.apart.x(), start.path_velocity.x(),
        static_cast<Real>(start.force.x()) / c.system.mass;
    const oracle::State expected = oracle::after(c.system, state, c.duration_s);
    const Largest largest(c.system, state, c.duration_s);
    const HeldForceStep::Motion got = step.motion(start);
    if (largest.velocity == 0) {
      EXPECT_EQ(got.displacement, Vec3::Zero());
      EXPECT_EQ(got.velocity, Vec3::Zero());
      continue;
    }
    worst = std::max({worst, std::abs(got.displacement.x() - expected(0)) / largest.displacement,
                      std::abs(got.velocity.x() - expected(1)) / largest.velocity});
  }
  return worst;
}

// The ends of the settings, and a thousand cases between them.
TEST(HeldForceStep, AgreesWithMatrixExponentialsWithinItsBound) {
  std::vector<Case> cases = {{{0.01, 1e5, 0, 0}, 0.01},
                             {{0.01, 1e5, 1000, 0}, 0.01},
                             {{0.01, 0, 1000, 0}, 0.01},
                             {{0.01, 100, 0, 1000}, 0.01},
                             {{100, 1, 0, 0}, 1e-4},
                             {{100, 0, 0, 0}, 1e-4},
                             {{1, 1e6, 2000, 0}, 0.001},
                             {{1, 1e6, 1999.999999, 0}, 0.001},
                             {{1, 1e6, 2000.000001, 0}, 0.001},
                             {{1e-5, 100, 0, 0}, 0.01},
                             {{1e-5, 100, 100, 0}, 0.01},
                             {{10, 1000, 100, 0}, 1e-4}};
  Draw draw(1);
  while (cases.size() < 1000) cases.push_back(draw_case(draw));
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto& [system, duration_s] = cases[i];
    ASSERT_LT(worst_error(cases[i]), 1e-13L)
        << "case " << i << ": m " << system.mass << " k " << system.stiffness << " c " << system.path_damping
        << " + " << system.ground_damping << " T " << duration_s;
  }
}

// --- energies ---

struct Drawn {
  Case c;
  HeldForceStep::Start start;
};

Drawn draw_start(Draw& draw) {
  Drawn d{draw_case(draw), {}};
  if (!draw.one_in(8)) d.start.apart = draw.vector(draw.log_between(1e-5, 0.1));
  if (!draw.one_in(8)) d.start.velocity = draw.vector(draw.log_between(1e-3, 1));
  if (!draw.one_in(3)) d.start.path_velocity = draw.vector(draw.log_between(1e-3, 1));
  if (!draw.one_in(5)) d.start.force = draw.vector(draw.log_between(1e-2, 100));
  return d;
}

// Each energy by itself, from the change of the state and from integrals of squares.
StepEnergy expected_energy(const Drawn& d) {
  const MassOnSpring& system = d.c.system;
  StepEnergy e;
  for (int axis = 0; axis < 3; ++axis) {
    oracle::State start, slip, speed;
    start << 0, d.start.velocity(axis), d.start.apart(axis), d.start.path_velocity(axis),
        static_cast<Real>(d.start.force(axis)) / system.mass;
    slip << 0, 1, 0, -1, 0;
    speed << 0, 1, 0, 0, 0;
    const Real t = d.c.duration_s, m = system.mass, k = system.stiffness;
    const oracle::State change = oracle::change(system, start, t);
    const Real apart_change = change(2) - change(0);
    e.force_work_J += static_cast<double>(d.start.force(axis) * change(0));
    e.kinetic_J += static_cast<double>(m / 2 * change(1) * (2 * start(1) + change(1)));
    e.potential_J += static_cast<double>(k / 2 * apart_change * (2 * start(2) + apart_change));
    e.path_damper_J +=
        static_cast<double>(system.path_damping * oracle::square_integral(system, start, slip, t));
    e.ground_damper_J +=
        static_cast<double>(system.ground_damping * oracle::square_integral(system, start, speed, t));
    // The integral of Newton's law gives the impulse of the path's spring and damper.
    const Real impulse = m * change(1) - d.start.force(axis) * t + system.ground_damping * change(0);
    e.path_work_J += static_cast<double>(d.start.path_velocity(axis) * impulse);
  }
  return e;
}

TEST(HeldForceStep, EveryEnergyAgreesWithIntegralsOfTheMotion) {
  Draw draw(3);
  for (int i = 0; i < 300; ++i) {
    const Drawn d = draw_start(draw);
    const StepEnergy got = HeldForceStep(d.c.system, d.c.duration_s).energy(d.start);
    const StepEnergy expected = expected_energy(d);
    const double size = std::abs(expected.force_work_J) + std::abs(expected.path_work_J) +
                        expected.dissipated_J() + std::abs(expected.kinetic_J) +
                        std::abs(expected.potential_J);
    for (const auto part : {&StepEnergy::force_work_J, &StepEnergy::path_work_J, &StepEnergy::path_damper_J,
                            &StepEnergy::ground_damper_J, &StepEnergy::kinetic_J, &StepEnergy::potential_J})
      ASSERT_NEAR(got.*part, expected.*part, 1e-10 * size) << "case " << i;
  }
}

// --- dry friction ---

HeldForceStep::Start along_x(double apart, double velocity, double path_velocity, double force) {
  return {Vec3(apart, 0, 0), Vec3(velocity, 0, 0), Vec3(path_velocity, 0, 0), Vec3(force, 0, 0)};
}

TEST(DryFriction, HoldsAMassAgainstAnyForceUpToIts) {
  const DryFrictionStep step({0.5, 1000, 0, 1}, 2, 0.001);
  EXPECT_EQ(step.motion(along_x(0, 0, 0, 2)).displacement.x(), 0);
  EXPECT_EQ(step.motion(along_x(-0.002, 0, 0, 0)).displacement.x(), 0);
  EXPECT_EQ(step.motion(along_x(0.001, 0, 0, 1)).displacement.x(), 0);
  EXPECT_GT(step.motion(along_x(0.001, 0, 0, 1.001)).displacement.x(), 0);
  EXPECT_LT(step.motion(along_x(0, 0, 0, -2.001)).displacement.x(), 0);
}

// The swings, without damping, of a mass on a spring shrink by 2 F_c / k from side to side, and the mass
// stops where the spring is weaker than friction. Ten swings in one tick.
TEST(DryFriction, ShrinksTheSwingsByTwiceItsWidth) {
  const double mass = 0.02, k = 2000, friction = 0.5;
  const double half_s = std::acos(-1.0) * std::sqrt(mass / k);
  const double first = 0.01;  // -> -0.0095, 0.009, ... : each half swing is 0.0005 shorter
  for (int halves = 1; halves <= 10; ++halves) {
    const auto motion =
        DryFrictionStep({mass, k, 0, 0}, friction, halves * half_s).motion(along_x(-first, 0, 0, 0));
    const double at = (halves % 2 == 0 ? 1 : -1) * (first - halves * 2 * friction / k);
    EXPECT_NEAR(first + motion.displacement.x(), at, 1e-13) << halves;
    EXPECT_NEAR(motion.velocity.x(), 0, 1e-10) << halves;
  }
  // 0.01 - 20 * 0.0005 = 0 is inside the zone of +- 0.00025 in which it rests.
  const auto end = DryFrictionStep({mass, k, 0, 0}, friction, 25 * half_s).motion(along_x(-first, 0, 0, 0));
  EXPECT_EQ(end.velocity.x(), 0);
  EXPECT_LE(std::abs(first + end.displacement.x()), friction / k);
}

struct Rubbed {
  MassOnSpring system;
  double friction, tick_s;
  HeldForceStep::Start start;
};

Rubbed random_case(unsigned seed) {
  Draw draw(seed);
  Rubbed c;
  c.system = {std::exp(draw.between(-4, 1)), std::exp(draw.between(0, 9)), draw.between(0, 5),
              draw.between(0, 5)};
  if (seed % 4 == 0) c.system.stiffness = 0;
  c.friction = std::exp(draw.between(-4, 2)), c.tick_s = seed % 3 == 0 ? 0.01 : 0.001;
  // Speeds that friction stops within a few ticks, so that most ticks have a stop.
  const double v = seed % 5 == 0 ? 0 : draw.between(-2, 2) * c.friction * c.tick_s / c.system.mass;
  c.start = along_x(draw.between(-2, 2) * c.friction / (c.system.stiffness + 1), v, draw.between(-0.3, 0.3),
                    draw.between(-2, 2) * c.friction);
  return c;
}

// The oracle: steps of a 2000th of a tick by matrix exponentials, with the direction of friction chosen at
// each. Its errors are those of a stop inside a step.
oracle::State scanned(const Rubbed& c) {
  const int steps = 2000;
  const Real dt = static_cast<Real>(c.tick_s) / steps, m = c.system.mass, f = c.friction;
  const auto generator = oracle::generator(c.system);
  const oracle::Matrix step = oracle::exponential_less_one(generator, dt);
  oracle::State state;
  state << -c.start.apart.x(), c.start.velocity.x(), 0, c.start.path_velocity.x(), 0;
  const Real force = c.start.force.x();
  for (int i = 0; i < steps; ++i) {
    state[4] = force / m;
    const Real pull = m * (generator.row(1) * state)(0);
    Real direction = state[1] > 0 ? 1 : state[1] < 0 ? -1 : pull > 0 ? 1 : -1;
    const bool sticks = state[1] == 0 && std::abs(pull) <= f;
    if (sticks) {
      state[2] += state[3] * dt;
      continue;
    }
    state[4] = (force - direction * f) / m;
    const oracle::State next = state + step * state;
    const bool stops = direction * next[1] < 0;
    state = next;
    if (stops) state[1] = 0;
  }
  return state;
}

TEST(DryFriction, AgreesWithAScanInSmallSteps) {
  int stopped = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const Rubbed c = random_case(seed);
    const auto motion = DryFrictionStep(c.system, c.friction, c.tick_s).motion(c.start);
    const oracle::State end = scanned(c);
    const double speed = std::abs(c.start.velocity.x()) + 4 * c.friction * c.tick_s / c.system.mass +
                         std::abs(c.start.path_velocity.x());
    const double way = static_cast<double>(end[0]) + c.start.apart.x();
    EXPECT_NEAR(motion.displacement.x(), way, 2e-3 * speed * c.tick_s) << seed;
    EXPECT_NEAR(motion.velocity.x(), static_cast<double>(end[1]), 5e-3 * speed) << seed;
    stopped += motion.velocity.x() == 0;
  }
  EXPECT_GT(stopped, 3);
}

TEST(DryFriction, KeepsTheBalanceOfEnergy) {
  for (unsigned seed = 1; seed <= 2000; ++seed) {
    const Rubbed c = random_case(seed);
    const DryFrictionStep step(c.system, c.friction, c.tick_s);
    const StepEnergy energy = step.energy(c.start);
    const double turnover =
        std::abs(energy.force_work_J) + std::abs(energy.path_work_J) + energy.dissipated_J();
    ASSERT_NEAR(energy.gained_J() + energy.dissipated_J(), energy.supplied_J(), 1e-9 * turnover + 1e-18)
        << seed;
    ASSERT_GE(energy.dry_friction_J, -1e-18) << seed;
    const double v = step.motion(c.start).velocity.x(), before = c.start.velocity.x();
    ASSERT_NEAR(energy.kinetic_J, c.system.mass / 2 * (v * v - before * before),
                1e-9 * c.system.mass / 2 * (v * v + before * before) + 1e-18)
        << seed;
  }
}

TEST(DryFriction, ActsAlongEachAxisByItself) {
  const DryFrictionStep step({0.5, 200, 1, 1}, 1, 0.001);
  HeldForceStep::Start start{Vec3(0.01, -0.02, 0.001), Vec3(0.1, 0, -0.001), Vec3(0, 0.1, 0.2),
                             Vec3(3, 0, -1)};
  const auto all = step.motion(start);
  for (int i = 0; i < 3; ++i) {
    const auto one =
        step.motion(along_x(start.apart[i], start.velocity[i], start.path_velocity[i], start.force[i]));
    EXPECT_EQ(all.displacement[i], one.displacement.x()) << i;
    EXPECT_EQ(all.velocity[i], one.velocity.x()) << i;
  }
}

}  // namespace
}  // namespace remote_touch::held_motion_test
