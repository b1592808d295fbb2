#include "runners/experiment/hand/simulated_hand.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {
namespace {

// Derivation of the error bound in the header, in units of the roundoff 2^-53. Every coefficient is computed
// as a Taylor series for T / 2^s, and addition theorems then double that time s times.
//
// Series: n! |f_n| <= M^(n-1) with M = d + sqrt(w) and M T / 2^s <= 1/2. What is left out is below 1e-24 of
// the first term; each sum is above 0.6 of its first term and begins with the smallest: less than 3
// roundoffs. Doubling without oscillation (d^2 >= 4 w): the sums in double_up() have positive terms, and a
// relative error enters the next level with a factor of at most 1. At most 4 roundoffs on each of less than
// 20 levels: 80. Doubling with oscillation squares z = (1 - w psi) + i sqrt(w) phi in the unit circle, so the
// error doubles on each level. Those before an angle of 1 add 2 roundoffs of the angle each, those after it
// at most 10 of 1. At the angle a = sqrt(w) T this is 7 a and less than 20 a: 27 (1 + a), and 27 * 33
// roundoffs are 9.9e-14.

constexpr int kTerms = 19;
constexpr double kSeriesRange = 0.5;

// phi, psi and chi after the time t, and the integrals of psi^2, phi^2 and phi'^2 from 0 to t. The integrals
// are not valid with Squares::left_out.
struct Responses {
  double t = 0, phi = 0, psi = 0, chi = 0, psi_psi = 0, phi_phi = 0, slope_slope = 0;
};

enum class Squares { left_out, integrated };

// Returns the responses after a short time t.
Responses series(double w, double d, double t, Squares squares) {
  assert((d + std::sqrt(w)) * t <= 0.5);
  // phi = t sum(term), phi' = sum(slope) and psi = t^2 sum(area), where term[n] is f_(n+1) t^n.
  double term[kTerms], slope[kTerms], area[kTerms];
  const double wt = w * t * t, dt = d * t;
  term[0] = 1, term[1] = -dt / 2;
  for (int n = 2; n < kTerms; ++n) term[n] = -(dt * n * term[n - 1] + wt * term[n - 2]) / (n * (n + 1));
  for (int n = 0; n < kTerms; ++n) slope[n] = (n + 1) * term[n], area[n] = term[n] / (n + 2);
  double phi = 0, psi = 0, chi = 0, psi_psi = 0, phi_phi = 0, slope_slope = 0;
  for (int n = kTerms - 1; n >= 0; --n) {
    phi += term[n];
    psi += area[n];
    chi += area[n] / (n + 3);
    if (squares == Squares::left_out) continue;
    double area_square = 0, square = 0, slope_square = 0;  // the terms of order n of the squares
    for (int k = 0; k <= n; ++k) {
      area_square += area[k] * area[n - k];
      square += term[k] * term[n - k];
      slope_square += slope[k] * slope[n - k];
    }
    psi_psi += area_square / (n + 5);
    phi_phi += square / (n + 3);
    slope_slope += slope_square / (n + 1);
  }
  const double tt = t * t, ttt = tt * t;
  return {t, t * phi, tt * psi, ttt * chi, tt * ttt * psi_psi, ttt * phi_phi, t * slope_slope};
}

// Returns the responses after twice the time of r. Let s be the time since the middle, and let a = phi'(t) +
// d phi(t) = 1 - w psi(t). Then
//   psi(t + s) = psi(t) + a psi(s) + phi(t) phi(s),   phi(t + s) = a phi(s) + phi(t) phi'(s),
//   phi'(t + s) = phi'(t) phi'(s) - w phi(t) phi(s),
// and 2 psi phi and 2 phi phi' are the derivatives of psi^2 and phi^2.
Responses double_up(double w, double d, const Responses& r) {
  const double a = 1 - w * r.psi, slope = a - d * r.phi;
  Responses next;
  next.t = 2 * r.t;
  next.phi = r.phi * (2 - 2 * w * r.psi - d * r.phi);
  next.psi = r.psi * (2 - w * r.psi) + r.phi * r.phi;
  next.chi = r.chi * (2 - w * r.psi) + r.psi * (r.t + r.phi);
  const double square = r.phi * r.phi;
  next.psi_psi = r.psi_psi + r.t * r.psi * r.psi + a * a * r.psi_psi + square * r.phi_phi +
                 2 * r.psi * (a * r.chi + r.phi * r.psi) + a * r.phi * r.psi * r.psi;
  next.phi_phi = r.phi_phi + a * a * r.phi_phi + a * r.phi * square + square * r.slope_slope;
  next.slope_slope =
      r.slope_slope + slope * slope * r.slope_slope - w * r.phi * slope * square + w * w * square * r.phi_phi;
  return next;
}

Responses responses(double w, double d, double duration_s, Squares squares) {
  double t = duration_s;
  int doublings = 0;
  for (const double rate = d + std::sqrt(w); rate * t > kSeriesRange; ++doublings) t *= 0.5;
  Responses r = series(w, d, t, squares);
  for (; doublings > 0; --doublings) r = double_up(w, d, r);
  return r;
}

// Why the first stop of a sliding mass is found for certain: friction is constant while the mass slides, so
// the acceleration a = x'' obeys a'' + d a' + w a = 0, as the force is held and the path has no acceleration.
// Two zeros of a are at least pi / sqrt(w) apart. In a piece shorter than that the velocity has at most one
// extremum, which bisection on a finds, and then at most one zero before and one after the extremum.

constexpr double kPieceAngle = 1.5;  // largest sqrt(w) t of a piece, below pi

// Each stop takes half an oscillation of the mass, so far fewer occur in a tick of a hand that the settings
// accept. The limit ends a tick in which rounding makes the mass start and stop without a motion.
constexpr int kMaxStops = 200;

// Returns the latest time in [low, high] up to which `before` holds. pre: it holds at low, or low is 0, and
// it holds up to one time and not after it.
template <class Predicate>
double last_time(double low, double high, Predicate before) {
  for (;;) {
    const double middle = low + (high - low) / 2;
    if (!(middle > low && middle < high)) return high;
    (before(middle) ? low : high) = middle;
  }
}

}  // namespace

StepEnergy& StepEnergy::operator+=(const StepEnergy& other) {
  force_work_J += other.force_work_J, path_work_J += other.path_work_J;
  path_damper_J += other.path_damper_J, ground_damper_J += other.ground_damper_J;
  dry_friction_J += other.dry_friction_J;
  kinetic_J += other.kinetic_J, potential_J += other.potential_J;
  return *this;
}

HeldForceStep::HeldForceStep(const MassOnSpring& system, double duration_s)
    : system_(system),
      duration_s_(duration_s),
      w_(system.stiffness / system.mass),
      d_((system.path_damping + system.ground_damping) / system.mass) {
  const Responses r = responses(w_, d_, duration_s, Squares::left_out);
  phi_ = r.phi, psi_ = r.psi, chi_ = r.chi;
  slope_ = 1 - w_ * psi_ - d_ * phi_;
}

// Returns the acceleration at the start, without the damping that the velocity of the mass itself causes.
Vec3 HeldForceStep::pull(const Start& start) const {
  return (start.force + system_.stiffness * start.apart + system_.path_damping * start.path_velocity) /
         system_.mass;
}

HeldForceStep::Motion HeldForceStep::motion(const Start& start) const {
  const Vec3 r = pull(start), ramp = w_ * start.path_velocity;
  return {phi_ * start.velocity + psi_ * r + chi_ * ramp, slope_ * start.velocity + phi_ * r + psi_ * ramp};
}

// The energies need integrals of e = x - p, e'^2 and x'^2. The motion gives e' = e'(0) phi' + r phi and x' =
// x'(0) phi' + pull phi + w p' psi, so these integrals are closed forms in phi, psi, chi and the integrals of
// squares. No energy is derived from the energy balance, so the balance is an independent check. Changes are
// computed directly, and not as differences of nearly equal numbers.
StepEnergy HeldForceStep::energy(const Start& start) const {
  // A path without spring and damper has no effect, however fast it is.
  const bool follows = system_.stiffness > 0 || system_.path_damping > 0;
  const Vec3 path_velocity = follows ? start.path_velocity : Vec3(Vec3::Zero());
  const Vec3 slip = start.velocity - path_velocity;  // e'(0)
  const Vec3 r =
      (start.force + system_.stiffness * start.apart - system_.ground_damping * path_velocity) / system_.mass;
  const Vec3 apart_sum = duration_s_ * start.apart - psi_ * slip - chi_ * r;  // the integral of p - x
  const Vec3 apart_change = -(phi_ * slip + psi_ * r);
  const Vec3 velocity_change = phi_ * r - (w_ * psi_ + d_ * phi_) * slip;
  const Responses integrals = responses(w_, d_, duration_s_, Squares::integrated);
  const Vec3 a = pull(start), ramp = w_ * path_velocity;
  const double velocity_squares =
      integrals.slope_slope * start.velocity.squaredNorm() + integrals.phi_phi * a.squaredNorm() +
      integrals.psi_psi * ramp.squaredNorm() + phi_ * phi_ * a.dot(start.velocity) +
      2 * (phi_ * psi_ - integrals.phi_phi) * ramp.dot(start.velocity) + psi_ * psi_ * a.dot(ramp);

  StepEnergy energy;
  energy.force_work_J = start.force.dot(motion(start).displacement);
  energy.path_work_J = path_velocity.dot(system_.stiffness * apart_sum + system_.path_damping * apart_change);
  energy.path_damper_J =
      system_.path_damping * (integrals.slope_slope * slip.squaredNorm() + phi_ * phi_ * slip.dot(r) +
                              integrals.phi_phi * r.squaredNorm());
  energy.ground_damper_J = system_.ground_damping * velocity_squares;
  energy.kinetic_J = 0.5 * system_.mass * velocity_change.dot(2 * start.velocity + velocity_change);
  energy.potential_J = 0.5 * system_.stiffness * apart_change.dot(2 * start.apart + apart_change);
  return energy;
}

// The state of one axis; remaining_s is the part of the tick that is left.
struct DryFrictionStep::Axis {
  double apart = 0, velocity = 0, path_velocity = 0, force = 0;
  double remaining_s = 0, displacement = 0;

  HeldForceStep::Start start(double friction_force) const {
    const auto along = [](double value) { return Vec3(value, 0, 0); };
    return {along(apart), along(velocity), along(path_velocity), along(force + friction_force)};
  }
};

DryFrictionStep::DryFrictionStep(const MassOnSpring& system, double friction, double duration_s)
    : system_(system), friction_(friction), duration_s_(duration_s) {}

// Returns the state after sliding in one direction (1 or -1).
DryFrictionStep::Axis DryFrictionStep::after(const Axis& axis, double direction, double duration_s) const {
  const HeldForceStep::Motion motion =
      HeldForceStep(system_, duration_s).motion(axis.start(-direction * friction_));
  Axis next = axis;
  next.displacement += motion.displacement.x();
  next.apart += axis.path_velocity * duration_s - motion.displacement.x();
  next.velocity = motion.velocity.x();
  next.remaining_s -= duration_s;
  return next;
}

// Returns the acceleration times the mass of an axis that slides in a direction.
double DryFrictionStep::acceleration(const Axis& axis, double direction) const {
  return axis.force - direction * friction_ + system_.stiffness * axis.apart +
         system_.path_damping * (axis.path_velocity - axis.velocity) - system_.ground_damping * axis.velocity;
}

// Returns the time until an axis that slides in a direction stops; longest_s if it does not stop before.
double DryFrictionStep::sliding_time(const Axis& axis, double direction, double longest_s) const {
  const double angle = std::sqrt(system_.stiffness / system_.mass) * longest_s;
  const int pieces = std::max(1, static_cast<int>(std::ceil(angle / kPieceAngle)));
  const auto slides = [&](double t) { return direction * after(axis, direction, t).velocity > 0; };
  const auto pulls = [&](double t) { return direction * acceleration(after(axis, direction, t), direction); };
  double begin = 0, pull_at_begin = direction * acceleration(axis, direction);
  if (axis.velocity == 0) pull_at_begin = std::max(0.0, pull_at_begin);  // rounding where a rest ends
  for (int piece = 1; piece <= pieces; ++piece) {
    const double end = longest_s * piece / pieces;
    if (!slides(end)) return last_time(begin, end, slides);
    const double pull_at_end = pulls(end);
    if (pull_at_begin < 0 && pull_at_end > 0) {  // the velocity has a minimum in between
      const double slowest = last_time(begin, end, [&](double t) { return pulls(t) < 0; });
      if (!slides(slowest)) return last_time(begin, slowest, slides);
    }
    begin = end, pull_at_begin = pull_at_end;
  }
  return longest_s;
}

void DryFrictionStep::slide(Axis& axis, double direction, double duration_s, StepEnergy* energy) const {
  const Axis before = axis;
  axis = after(axis, direction, duration_s);
  if (energy == nullptr) return;
  StepEnergy part = HeldForceStep(system_, duration_s).energy(before.start(-direction * friction_));
  const double distance = axis.displacement - before.displacement;
  part.dry_friction_J = direction * friction_ * distance;
  part.force_work_J = axis.force * distance;
  *energy += part;
}

void DryFrictionStep::rest(Axis& axis, double duration_s, StepEnergy* energy) const {
  const double way = axis.path_velocity * duration_s;
  if (energy != nullptr) {
    StepEnergy part;
    part.potential_J = system_.stiffness * way * (axis.apart + way / 2);
    part.path_damper_J = system_.path_damping * axis.path_velocity * way;
    part.path_work_J = part.potential_J + part.path_damper_J;
    *energy += part;
  }
  axis.apart += way, axis.remaining_s -= duration_s;
}

void DryFrictionStep::advance(Axis& axis, StepEnergy* energy) const {
  for (int stops = 0; axis.remaining_s > 0; ++stops) {
    double direction = axis.velocity > 0 ? 1 : -1;
    if (axis.velocity == 0) {
      const double pull = acceleration(axis, 0);
      direction = pull > 0 ? 1 : -1;
      if (std::abs(pull) <= friction_) {
        const double rate = system_.stiffness * axis.path_velocity;  // change of the pull per second
        direction = rate > 0 ? 1 : -1;
        const double until_s = rate == 0 ? axis.remaining_s : (direction * friction_ - pull) / rate;
        if (until_s >= axis.remaining_s || stops >= kMaxStops) return rest(axis, axis.remaining_s, energy);
        rest(axis, until_s, energy);
      }
    }
    const double sliding_s = sliding_time(axis, direction, axis.remaining_s);
    const bool stops_here = sliding_s < axis.remaining_s;
    slide(axis, direction, sliding_s, energy);
    if (stops_here || direction * axis.velocity < 0) axis.velocity = 0;
  }
}

HeldForceStep::Motion DryFrictionStep::motion(const HeldForceStep::Start& start) const {
  HeldForceStep::Motion motion;
  for (int i = 0; i < 3; ++i) {
    Axis axis{start.apart[i], start.velocity[i], start.path_velocity[i], start.force[i], duration_s_};
    advance(axis, nullptr);
    motion.displacement[i] = axis.displacement, motion.velocity[i] = axis.velocity;
  }
  return motion;
}

StepEnergy DryFrictionStep::energy(const HeldForceStep::Start& start) const {
  StepEnergy sum;
  for (int i = 0; i < 3; ++i) {
    Axis axis{start.apart[i], start.velocity[i], start.path_velocity[i], start.force[i], duration_s_};
    advance(axis, &sum);
  }
  return sum;
}

}  // namespace remote_touch
