#include "analysis/measures/replay_measures.h"

#include <cmath>

#include "analysis/measures/contact_force.h"
#include "analysis/measures/no_value.h"
#include "analysis/statistics/mean.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

namespace {

// False for an unknown force.
bool is_contact(const Vec3& force_N) {
  return force_N.norm() > kContactForce_N;
}
bool is_expected(const Vec3& expected_N) {
  return expected_N.norm() > kExpectedContact_N;
}

// Mean of value(expected force, rendered force) over the ticks for which qualifies() of the same two is true
// and the expected force is known.
template <class Qualifies, class Value>
double mean_of_replay(const Trace& trace, Qualifies&& qualifies, Value&& value) {
  return mean_where(
      trace.expected_force_N.size(),
      [&](std::size_t i) {
        const Vec3& expected_N = trace.expected_force_N[i];
        return expected_N.allFinite() && qualifies(expected_N, contact_force_N(trace, i));
      },
      [&](std::size_t i) { return value(trace.expected_force_N[i], contact_force_N(trace, i)); });
}

bool always(const Vec3&, const Vec3&) {
  return true;
}

double mean_square_error(const Trace& trace) {
  return mean_of_replay(trace, always, [](const Vec3& expected, const Vec3& force) {
    return (force - expected).squaredNorm();
  });
}

}  // namespace

double rms_force_error_N(const Trace& trace) {
  const double error = mean_square_error(trace);
  return std::isnan(error) ? kNoValue : std::sqrt(error);
}

double relative_force_error(const Trace& trace) {
  const double error = mean_square_error(trace);
  const double square =
      mean_of_replay(trace, always, [](const Vec3& expected, const Vec3&) { return expected.squaredNorm(); });
  return std::isnan(error) || !(square > 0) ? kNoValue : std::sqrt(error / square);
}

double force_direction_error_rad(const Trace& trace) {
  return mean_of_replay(
      trace,
      [](const Vec3& expected, const Vec3& force) { return is_expected(expected) && is_contact(force); },
      [](const Vec3& expected, const Vec3& force) {
        return std::atan2(expected.cross(force).norm(), expected.dot(force));
      });
}

double false_contact_fraction(const Trace& trace) {
  return mean_of_replay(
      trace, [](const Vec3& expected, const Vec3&) { return expected.isZero(0); },
      [](const Vec3&, const Vec3& force) { return force.allFinite() ? is_contact(force) : kNoValue; });
}

double lost_contact_fraction(const Trace& trace) {
  return mean_of_replay(
      trace, [](const Vec3& expected, const Vec3&) { return is_expected(expected); },
      [](const Vec3&, const Vec3& force) { return !is_contact(force); });
}

}  // namespace remote_touch
