#include "core/dissertation/proxy/proxy_motion.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <utility>

#include "core/kernels/kernels.h"

namespace remote_touch {

Parameters parameters(ProxyParameters& p) {
  return {
      {"r1_m", &p.r1_m, 1e-6, 1,
       "the proxy is entrenched where the distance r_n (5.5) is below this, Fig 4.2, 5.3", kLive},
      {"r2_m", &p.r2_m, 1e-6, 1,
       "the proxy is in contact where the distance is from r1 to this; the contact radius r_c is (r1 + r2) / 2",
       kLive},
      {"r3_m", &p.r3_m, 1e-6, 1, "radius of the points that are averaged to the normal (4.1)", kLive},
      {"theta_deg", &p.theta_deg, 0, 90,
       "convergence angle: a contact has converged when -u and the normal differ by less (4.8)"},
      {"gamma", &p.gamma, 1e-3, 1, "near the goal: step length as a fraction of the distance to it (4.11)"},
      {"xi", &p.xi, 1e-3, 0.999, "far from the goal: step length in units of r1 (4.12)"},
      {"stiffness_N_per_m", &p.stiffness_N_per_m, 0, 10000, "spring k_s of the virtual coupling (4.16)",
       kLive},
      {"damping_Ns_per_m", &p.damping_Ns_per_m, 0, 1000, "damper k_d of the virtual coupling (4.16)"},
      {"steps_per_tick", &p.steps_per_tick, 1, 100000,
       "maximum number of proxy steps in a haptic tick; recommended where time matters: 8 with gamma = 0.5, with which the proxy rests within 20 um of the position of 30 with gamma = 0.3, in 0.3 of the time"},
      {"max_exit_steps", &p.max_exit_steps, 0, 1000,
       "maximum number of extra steps (5.11) when a tick would end inside a forbidden region; 0: as printed"},
      {"velocity_estimate", &p.velocity_estimate, 0, 1,
       "estimate the velocity of the cloud (4.13) and move the proxy with it at each frame (4.3)", kLive},
      {"max_prediction_s", &p.max_prediction_s, 0, 10,
       "maximum time after a frame for which (4.3) and (4.15) extrapolate its motion; at least one frame interval"},
      {"growth_is_motion", &p.growth_is_motion, 0, 1,
       "true: the growth of a region under the proxy counts as motion in (4.13), as printed; false: the change of r_f "
       "between two frames does not count"},
      {"step_rule", choice(p.step_rule, {"variable", "fixed"}), 0, 0,
       "variable: step lengths of 4.2.4; fixed: small steps of one length as in the predecessor [1]"},
      {"fixed_step_m", &p.fixed_step_m, 1e-7, 0.01, "step length of step_rule = fixed"},
      {"free_root", choice(p.free_root, {"ahead", "smallest-magnitude"}), 0, 0,
       "root of (4.9), (5.9): ahead: only points in the direction of motion; smallest-magnitude: as printed"},
      {"contact_motion", choice(p.contact_motion, {"tangent-plane", "regions", "creases"}), 0, 0,
       "motion in contact: tangent-plane: in the plane of the mean normal (4.6), (5.16); regions: as close to the HIP as all touching regions allow; creases: regions where the direction from a touching region is more than 17 deg off the mean normal, else tangent-plane"},
      {"exit_rule", choice(p.exit_rule, {"towards-hip", "out-of-contact"}), 0, 0,
       "for contact_motion = tangent-plane when the HIP is outside: towards-hip: straight to the HIP (4.7); out-of-contact: r2 - r1 along the normal (5.17)"},
      {"velocity_force", choice(p.velocity_force, {"minus", "plus", "none"}), 0, 0,
       "sign of the velocity term of (4.15); plus is printed, but doubles the force jump instead of removing it"},
      {"damping_sign", choice(p.damping_sign, {"plus", "minus"}), 0, 0,
       "sign of the damping term in the bracket of (4.16); minus is printed, but adds energy"},
      {"force_gate", choice(p.force_gate, {"latest-contact", "contact-now"}), 0, 0,
       "latest-contact: send the force (4.16) until the proxy is free for a whole tick; contact-now: only if the tick ends in contact, as printed"},
      {"slave_command", choice(p.slave_command, {"proxy", "hip"}), 0, 0,
       "commanded position of the slave robot: proxy (hard constraint) or hip (soft constraint), 5.2"},
      {"slave_prediction", &p.slave_prediction, 0, 1,
       "in contact: add velocity estimate times age of the frame to the position of the slave"},
  };
}

Parameters with_fixed_radii(Parameters list) {
  for (Parameter& p : list) p.is_live &= p.name != "r1_m" && p.name != "r2_m" && p.name != "r3_m";
  return list;
}

std::string validate(const ProxyParameters& p) {
  std::ostringstream text;
  if (!(p.r1_m < p.r2_m))
    text << "r1_m = " << p.r1_m << ": expected below r2_m = " << p.r2_m;
  else if (!(p.r2_m < p.r3_m))
    text << "r2_m = " << p.r2_m << ": expected below r3_m = " << p.r3_m;
  return text.str();
}

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
    const auto d = equations::roots<double>(p_W, {points.x[i], points.y[i], points.z[i]}, u,
                                            radius + (points.radius ? points.radius[i] : 0));
    if (!d) continue;
    const double root = std::abs(d->near) <= std::abs(d->far) ? d->near : d->far;
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
  return distance < p.r1_m ? Vec3(p.gamma * goal)                   // (4.11)
                           : along(goal, p.xi * p.r1_m, distance);  // (4.12)
}

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

Vec3 unit_or(const Vec3& v, const Vec3& other) {
  const double length = v.norm();
  return length > 0 ? Vec3(v / length) : other;
}

std::array<Vec3, 9> directions(const Vec3& normal_W, const Vec3& u) {
  const Vec3 n = unit_or(normal_W, unit_or(-u, Vec3::UnitY()));
  int min = 0;
  n.cwiseAbs().minCoeff(&min);
  // The component of u across the normal. It is only rounding if u runs along the normal.
  const Vec3 across = u - u.dot(n) * n;
  const bool has_direction = across.squaredNorm() > 1e-24 * u.squaredNorm();
  const Vec3 a = unit_or(has_direction ? across : n.cross(Vec3::Unit(min)), Vec3::Zero()), b = n.cross(a);
  constexpr double kHalfWay = 0.70710678118654752;
  return {n, kHalfWay * (n + a), kHalfWay * (n - a), kHalfWay * (n + b), kHalfWay * (n - b), a, -a, b, -b};
}

// Returns the distance along a line to the first position outside all regions. Returns infinity if that
// distance is max_m or more, or if the line is not outside after kMaxExits regions.
double exit_along(Neighbourhood& near, const Kernels& kernels, const Vec3& p_W, const Vec3& direction,
                  double max_m, const ProxyParameters& p) {
  const auto outside = [&](const PointsView& points, const Vec3& q_W) {
    const ProxyRegions regions{p.r1_m, p.r2_m, p.r3_m, near.sum_grid(), p.stiffness_N_per_m};
    const double nearest_m = kernels.proxy.contact_query(points, q_W.data(), regions).nearest;
    return classify(nearest_m, p) != ContactState::entrenched;
  };
  double done_m = 0;
  for (int exits = 0; done_m < max_m; ++exits) {
    const Vec3 q_W = p_W + done_m * direction;
    const PointsView points = near.around(q_W).view();
    if (outside(points, q_W)) return done_m;
    if (exits == kMaxExits) break;
    done_m += kernels.proxy.exit_distance(points, q_W.data(), direction.data(), p.contact_radius_m(), p.r1_m);
  }
  return std::numeric_limits<double>::infinity();
}

// A motion violates a normal if it goes against it by more than the rounding of unit vectors.
constexpr double kRounding = 1e-12;
// Every round ends farther from u than the one before, so the rounds end. The limit guards against rounding.
constexpr int kMaxRounds = 100;

// Orders normals by their coordinates, so that the choice among equal ones does not depend on the order of
// the points. Magnitudes are compared first, because left and right are alike.
bool comes_before(const Vec3& a, const Vec3& b) {
  const Vec3 size_a = a.cwiseAbs(), size_b = b.cwiseAbs();
  if (size_a != size_b)
    return std::lexicographical_compare(size_a.begin(), size_a.end(), size_b.begin(), size_b.end());
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

// Normals of the regions that hold a motion back. One normal leaves a plane to move in, two leave a line, and
// three leave no motion.
struct Barriers {
  std::array<Vec3, 3> normal{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  std::size_t count = 0;

  void add(const Vec3& n) {
    assert(count < normal.size());
    normal[count++] = n;
  }
};

// Returns v without its component along `by`.
Vec3 less(const Vec3& v, const Vec3& by) {
  return v - (v.dot(by) / by.squaredNorm()) * by;
}

// Finds the normal, among those of the touching regions, that the motion s violates most. Returns false if s
// violates none by more than the slack. The regions are not stored, because a proxy may touch very many.
bool find_most_violated_normal(const PointsView& points, const Vec3& p_W, double r2, const Vec3& s,
                               double slack, Vec3& normal) {
  double min = -slack;
  bool found = false;
  for (std::size_t i = 0; i < points.padded_count; ++i) {
    const Vec3 from = p_W - Vec3(points.x[i], points.y[i], points.z[i]);
    const double distance = from.norm(), reach = points.radius ? r2 + points.radius[i] : r2;
    if (!(distance <= reach) || distance == 0) continue;
    const Vec3 n = from / distance;
    const double along = n.dot(s);
    if (along < min || (found && along == min && comes_before(n, normal)))
      min = along, normal = n, found = true;
  }
  return found;
}

// Projects u onto the motions that up to three barriers allow. onto() keeps only the barriers that the result
// lies on.
class Projection {
 public:
  Projection(const Vec3& u, double slack) : u_(u), slack_(slack) {}

  Vec3 onto(Barriers& all) const {
    Best best;
    for (std::size_t i = 0; i < all.count; ++i) {
      on_plane(all, i, best);
      for (std::size_t j = i + 1; j < all.count; ++j) on_line(all, i, j, best);
    }
    all = best.barriers;
    return best.s;
  }

 private:
  struct Best {
    Vec3 s = Vec3::Zero();
    Barriers barriers{};
    double squared = std::numeric_limits<double>::infinity();
  };

  void on_plane(const Barriers& all, std::size_t i, Best& best) const {
    const Vec3& a = all.normal[i];
    Barriers one;
    one.add(a);
    offer(all, u_ - u_.dot(a) * a, one, best);
  }
  // The motion loses its components along both normals. The sum and the difference of the normals span the
  // same plane, and give the same bits whichever normal comes first. The shorter of the two has the less
  // accurate direction, so its component along the longer one is removed.
  void on_line(const Barriers& all, std::size_t i, std::size_t j, Best& best) const {
    const Vec3 &a = all.normal[i], &b = all.normal[j];
    Vec3 longer = a + b, shorter = a - b;
    if (longer.squaredNorm() < shorter.squaredNorm()) std::swap(longer, shorter);
    if (!(shorter.norm() > kRounding)) return;  // the normals are parallel: one plane
    shorter = less(shorter, longer);
    const double to_a = u_.dot(a), to_b = u_.dot(b), between = a.dot(b);
    const double push_a = between * to_b - to_a, push_b = between * to_a - to_b;
    if (std::min(push_a, push_b) < -slack_) return;  // a region holds back, it does not pull
    Barriers two;
    two.add(a), two.add(b);
    offer(all, less(less(u_, longer), shorter), two, best);
  }
  void offer(const Barriers& all, const Vec3& s, const Barriers& barriers, Best& best) const {
    for (std::size_t i = 0; i < all.count; ++i)
      if (all.normal[i].dot(s) < -slack_) return;
    const double squared = (u_ - s).squaredNorm();
    if (squared < best.squared) best = {s, barriers, squared};
  }

  const Vec3& u_;
  double slack_;
};

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
  return step >= distance ? u : Vec3(step * direction);  // (4.4) with d_k of (4.9)
}

Vec3 entrenched_step(const PointsView& points, const Kernels& kernels, const Vec3& p_W, const Vec3& normal,
                     const Vec3& u, const ProxyParameters& p) {
  Vec3 out = normal;
  if (out.isZero(0)) out = along(-u, 1, u.norm());
  if (out.isZero(0)) return Vec3::Zero();
  if (p.step_rule == StepRule::fixed) return p.fixed_step_m * out;
  const double d = kernels.proxy.exit_distance(points, p_W.data(), out.data(), p.contact_radius_m(), p.r1_m);
  return d * out;  // (4.5) with d_k of (4.10)
}

Vec3 contact_step(const Vec3& normal, const Vec3& u, const ProxyParameters& p) {
  const double height = u.dot(normal);
  if (p.exit_rule == ExitRule::out_of_contact && height >= 0 && !u.isZero(0))
    return (p.r2_m - p.r1_m) * normal;                          // (5.17)
  if (height < 0) return step_towards(u - height * normal, p);  // (4.6), in the tangent plane
  return step_towards(u, p);                                    // (4.7)
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
  return tangential.squaredNorm() < sine_squared(p.theta_deg) * u.squaredNorm();  // (4.8)
}

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

std::optional<Vec3> straight_exit(Neighbourhood& near, const Kernels& kernels, const Vec3& p_W,
                                  const Vec3& normal_W, const Vec3& u, const ProxyParameters& p) {
  double shortest_m = std::numeric_limits<double>::infinity();
  Vec3 exit_W = p_W;
  for (const Vec3& direction : directions(normal_W, u)) {
    const double length_m = exit_along(near, kernels, p_W, direction, shortest_m, p);
    if (length_m < shortest_m) shortest_m = length_m, exit_W = p_W + length_m * direction;
  }
  return shortest_m < std::numeric_limits<double>::infinity() ? std::optional(exit_W) : std::nullopt;
}

std::optional<double> nearest_region_radius_m(const PointsView& points, const Vec3& p_W) {
  double nearest_m = std::numeric_limits<double>::infinity();
  std::optional<double> radius_m;
  for (std::size_t i = 0; i < points.padded_count; ++i) {
    if (points.x[i] == kFarAway) continue;
    const double own_m = points.radius ? points.radius[i] : 0;
    const double distance_m = (p_W - Vec3(points.x[i], points.y[i], points.z[i])).norm() - own_m;
    if (distance_m < nearest_m || (distance_m == nearest_m && own_m < *radius_m))
      nearest_m = distance_m, radius_m = own_m;
  }
  return radius_m;
}

bool is_in_crease(const PointsView& points, const Vec3& p_W, const Vec3& normal_W, double r2, double cosine) {
  for (std::size_t i = 0; i < points.padded_count; ++i) {
    const Vec3 from = p_W - Vec3(points.x[i], points.y[i], points.z[i]);
    const double distance = from.norm(), reach = points.radius ? r2 + points.radius[i] : r2;
    if (distance <= reach && from.dot(normal_W) < cosine * distance) return true;
  }
  return false;
}

// Uses the dual method: the most violated region is added to the barriers until no region is violated.
std::optional<Vec3> admissible_motion(const PointsView& points, const Vec3& p_W, const Vec3& u, double r2) {
  const double slack = kRounding * u.norm();
  const Projection projection(u, slack);
  Barriers barriers;
  Vec3 s = u, normal = Vec3::Zero();
  for (int round = 0; round < kMaxRounds; ++round) {
    if (!find_most_violated_normal(points, p_W, r2, s, slack, normal)) return s;
    barriers.add(normal);
    s = projection.onto(barriers);
    if (s.isZero(0)) return s;  // held from all sides
  }
  return std::nullopt;
}

}  // namespace remote_touch
