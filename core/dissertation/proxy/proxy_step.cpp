#include "core/dissertation/proxy/proxy_step.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

namespace remote_touch {
namespace {

// A weighted sum of unit vectors that is shorter than this has no direction, because it consists of rounding
// errors.
constexpr double kNoDirection = 1e-10;

// A shorter distance to the next region is rounding: a region so near touches already.
constexpr double kNoMotion_m = 1e-12;

// Returns sin(theta)^2. It is computed as a series, because std::sin may differ in the last bit between
// machines. It is exact to 1e-16 below 1 rad and monotonic up to 90 degrees.
double sine_squared(double degrees) {
  const double a = 2 * degrees * (3.14159265358979323846 / 180), a2 = a * a;  // sin^2 t = (1 - cos 2t) / 2
  double term = 1, sum = 0;
  for (int k = 1; k <= 14; ++k) {
    term *= a2 / ((2 * k - 1) * (2 * k));
    sum += k % 2 == 1 ? term : -term;
  }
  return 0.5 * sum;
}

// Returns the step of (4.9) as printed. Each point has the root of smallest magnitude, ahead or behind, and
// the step is the smallest of these roots. Roots beyond the distance to the HIP, in either direction, are
// ignored.
double printed_free_root(const PointsView& points, const Vec3& p_W, const Vec3& u, double radius,
                         double limit) {
  double step = limit;
  for (std::size_t i = 0; i < points.padded_count; ++i) {
    const Vec3 e = Vec3(points.x[i], points.y[i], points.z[i]) - p_W;
    const double along = e.dot(u), r = radius + (points.radius ? points.radius[i] : 0);
    const double rest = r * r - (e - along * u).squaredNorm();
    if (!(rest >= 0)) continue;
    const double near = along - std::sqrt(rest), far = along + std::sqrt(rest);
    const double root = std::abs(near) <= std::abs(far) ? near : far;
    if (std::abs(root) <= limit) step = std::min(step, root);
  }
  return step;
}

Vec3 along(const Vec3& direction, double length, double norm) {
  return norm > 0 ? Vec3(direction * (length / norm)) : Vec3::Zero();
}

// Returns the step towards a goal, (4.11), (4.12): the fraction gamma of the way if the way is shorter than
// r1, else the length xi r1. The fixed rule of [1] makes small steps of one length.
Vec3 step_towards(const Vec3& goal, const ProxyParameters& p) {
  const double distance = goal.norm();
  if (p.step_rule == StepRule::fixed) return along(goal, std::min(p.fixed_step_m, distance), distance);
  return distance < p.r1_m ? Vec3(p.gamma * goal) : along(goal, p.xi * p.r1_m, distance);
}

}  // namespace

ContactState classify(double nearest_distance_m, const ProxyParameters& p) {
  if (nearest_distance_m < p.r1_m) return ContactState::entrenched;
  return nearest_distance_m <= p.r2_m ? ContactState::contact : ContactState::free;
}

Vec3 unit_normal(const ContactQuery& query, const Vec3& previous) {
  const Vec3 sum(query.normal_sum[0], query.normal_sum[1], query.normal_sum[2]);
  const double length = sum.norm();
  return length > kNoDirection ? Vec3(sum / length) : previous;
}

Vec3 free_step(Neighbourhood& near, const Vec3& p_W, const Vec3& u, const ProxyParameters& p) {
  const double distance = u.norm();
  if (!(distance > 0)) return Vec3::Zero();
  if (p.step_rule == StepRule::fixed) return step_towards(u, p);
  const Vec3 direction = u / distance;
  const double step = p.free_root == FreeRoot::ahead
                          ? near.first_hit(p_W, direction, p.contact_radius_m(), distance)
                          : printed_free_root(near.within(p_W, distance + p.contact_radius_m()).view(), p_W,
                                              direction, p.contact_radius_m(), distance);
  // A step without an obstacle is u itself, so that P meets the HIP bit for bit.
  return step >= distance ? u : Vec3(step * direction);
}

Vec3 entrenched_step(const PointsView& points, const Kernels& kernels, const Vec3& p_W, const Vec3& normal,
                     const Vec3& u, const ProxyParameters& p) {
  Vec3 out = normal;
  if (out.isZero(0)) out = along(-u, 1, u.norm());
  if (out.isZero(0)) return Vec3::Zero();
  if (p.step_rule == StepRule::fixed) return p.fixed_step_m * out;
  return kernels.proxy.exit_distance(points, p_W.data(), out.data(), p.contact_radius_m(), p.r1_m) * out;
}

Vec3 contact_step(const Vec3& normal, const Vec3& u, const ProxyParameters& p) {
  const double height = u.dot(normal);
  if (p.exit_rule == ExitRule::out_of_contact && height >= 0 && !u.isZero(0))
    return (p.r2_m - p.r1_m) * normal;
  return step_towards(height < 0 ? Vec3(u - height * normal) : u, p);
}

Vec3 region_step(Neighbourhood& near, const Vec3& p_W, const Vec3& goal, const Vec3& u,
                 const ProxyParameters& p) {
  if (goal == u) return free_step(near, p_W, u, p);
  const Vec3 step = step_towards(goal, p);
  const double length = step.norm();
  if (!(length > 0)) return Vec3::Zero();
  // The radius lies between r1 and r_c, so that a region that touches already, at r1 or more, is not met
  // again.
  const double reach = 0.5 * (p.r1_m + p.contact_radius_m());
  double path_length = near.first_hit(p_W, step / length, reach, length);
  // A region that ended an earlier step lies exactly at this distance. Rounding can make a motion along this
  // region meet it again at once, and the proxy would then stay forever. The goal enters no touching region,
  // so the distance is computed again with a smaller radius.
  if (path_length < kNoMotion_m)
    path_length = near.first_hit(p_W, step / length, 0.5 * (p.r1_m + reach), length);
  return step * (path_length / length);
}

bool has_converged(const std::optional<Vec3>& goal, const Vec3& u, const ProxyParameters& p) {
  return goal && goal->squaredNorm() < sine_squared(p.theta_deg) * u.squaredNorm();
}

bool has_converged(ContactState state, const Vec3& normal, const Vec3& u, const ProxyParameters& p) {
  if (state == ContactState::free) return u.isZero(0);
  if (state == ContactState::entrenched || !(u.dot(normal) < 0)) return false;
  const Vec3 tangential = u - u.dot(normal) * normal;
  return tangential.squaredNorm() < sine_squared(p.theta_deg) * u.squaredNorm();
}

namespace {

// Binary logarithm of the number of entries. Cycles of more positions are rare.
constexpr std::size_t kEntryBits = 8;

std::array<std::uint64_t, 3> bits(const Vec3& v) {
  return {std::bit_cast<std::uint64_t>(v.x()), std::bit_cast<std::uint64_t>(v.y()),
          std::bit_cast<std::uint64_t>(v.z())};
}

// Returns the index of the entry of a position. The factors are odd and without structure, so the upper bits
// of the sum depend on all bits of the position.
std::size_t entry_of(const Vec3& v) {
  const auto [x, y, z] = bits(v);
  return (x * 0x9E3779B97F4A7C15u + y * 0xC2B2AE3D27D4EB4Fu + z * 0x165667B19E3779F9u) >> (64 - kEntryBits);
}

}  // namespace

KnownSteps::KnownSteps() : entries_(std::size_t{1} << kEntryBits) {}

void KnownSteps::set_hip(const Vec3& hip_W) {
  if (bits(hip_W) == bits(hip_W_)) return;
  hip_W_ = hip_W;
  forget();
}

const KnownStep* KnownSteps::from(const Vec3& proxy_W) const {
  const Entry& entry = entries_[entry_of(proxy_W)];
  return entry.generation == generation_ && bits(entry.step.proxy_W) == bits(proxy_W) ? &entry.step : nullptr;
}

void KnownSteps::remember(const KnownStep& step) {
  entries_[entry_of(step.proxy_W)] = {generation_, step};
}

}  // namespace remote_touch
