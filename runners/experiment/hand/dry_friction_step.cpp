// Why the first stop of a sliding mass is found for certain: friction is constant while the mass slides, so
// the acceleration a = x'' obeys a'' + d a' + w a = 0, as the force is held and the path has no acceleration.
// Two zeros of a are at least pi / sqrt(w) apart. In a piece shorter than that the velocity has at most one
// extremum, which bisection on a finds, and then at most one zero before and one after the extremum.
#include "runners/experiment/hand/dry_friction_step.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

namespace {

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
