// Motion of the proxy. First the equations of 4.2 and 5.3, then one step of the movement algorithm, 4.2.3 and
// 4.2.4 (chapter 5: the same with r_n and r_f), and the motion among regions.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/kernels/point_kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/neighbour_search.h"
#include "core/points/vector.h"
#include "core/rendering/frames_and_outputs.h"

// The equations of 4.2 and 5.3 that a proxy P needs of every point x near it, one statement each. The kernels
// of core/kernels/point_kernels.h compute them for many points at a time and are tested against this form.
// Number: double or long double. Positions and radii are in m, directions have unit length.
namespace remote_touch::equations {

template <class Number>
using Vec = Eigen::Matrix<Number, 3, 1>;

// The distance r_n of P to the region of radius r_f around a point, (5.5); r_f is 0 for a bare point.
template <class Number>
Number distance(const Vec<Number>& P, const Vec<Number>& x, Number r_f) {
  return (P - x).norm() - r_f;  // (5.5)
}

// The modified Wendland function psi, (4.2).
template <class Number>
Number weight(Number r, Number r1, Number r3) {
  const Number t = (r - r1) / (r3 - r1);
  return r <= r1 ? 1 : r >= r3 ? 0 : (1 - t) * (1 - t) * (1 - t) * (1 - t) * (4 * t + 1);  // (4.2)
}

// The term of a point in the normal (4.1), with r_n in place of the distance, (5.5). A point at P has no
// direction: its term is zero.
template <class Number>
Vec<Number> normal_term(const Vec<Number>& P, const Vec<Number>& x, Number r_f, Number r1, Number r3) {
  const Number length = (P - x).norm();
  if (!(length > 0)) return Vec<Number>::Zero();
  return (P - x) / length * weight(distance(P, x, r_f), r1, r3);  // (4.1)
}

// The roots d of r_c + r_f = |x - P - d direction|, (4.9), (4.10), (5.9), (5.11).
template <class Number>
struct Roots {
  Number near, far;
};
// Returns nothing if no d reaches the region. The roots lie about the foot of x on the line, because the
// usual formula of a quadratic equation loses half of the digits.
template <class Number>
std::optional<Roots<Number>> roots(const Vec<Number>& P, const Vec<Number>& x, const Vec<Number>& direction,
                                   Number radius) {
  const Number foot = (x - P).dot(direction);
  const Number rest = radius * radius - (x - P - foot * direction).squaredNorm();
  if (!(rest >= 0)) return {};
  return Roots<Number>{foot - std::sqrt(rest), foot + std::sqrt(rest)};
}

// Returns how far a free proxy may go before it meets the region: the root of (4.9) ahead of it.
template <class Number>
std::optional<Number> first_hit(const Vec<Number>& P, const Vec<Number>& x, const Vec<Number>& direction,
                                Number radius) {
  const auto d = roots(P, x, direction, radius);
  return d && d->near > 0 ? std::optional<Number>(d->near) : std::nullopt;  // (4.9), (5.9)
}

// Returns how far an entrenched proxy has to go until the region, whose inner radius is r1 + r_f, holds it
// at its surface: the larger root of (4.10). 0 if the region does not entrench it.
template <class Number>
Number exit_distance(const Vec<Number>& P, const Vec<Number>& x, const Vec<Number>& direction, Number radius,
                     Number inner) {
  const auto d = roots(P, x, direction, radius);
  return d && (P - x).norm() < inner ? d->far : 0;  // (4.10), (5.11)
}

}  // namespace remote_touch::equations

namespace remote_touch {

// Settings of the point cloud proxy, Table 4.2, and the readings of an equation that can be chosen.

enum class StepRule { variable, fixed };            // 4.2.4, or the small fixed steps of the predecessor [1]
enum class FreeRoot { ahead, smallest_magnitude };  // root of (4.9); the second is the printed text
// Motion in contact. tangent_plane: (4.6), (5.16). regions: each touching region limits the motion by itself.
// creases: as regions in a crease, as tangent_plane elsewhere.
enum class ContactMotion { tangent_plane, regions, creases };
enum class ExitRule { towards_hip, out_of_contact };  // step in contact with the HIP outside: (4.7) or (5.17)
enum class DampingSign { plus, minus };  // sign of the k_d term in the bracket of (4.16); minus is printed
enum class ForceGate { latest_contact, contact_now };  // condition for sending (4.16); the second is printed

struct ProxyParameters {
  double r1_m = 0.00499;
  double r2_m = 0.00501;
  double r3_m = 0.01;
  double theta_deg = 0.1;
  double gamma = 0.3;
  double xi = 0.1;
  double stiffness_N_per_m = 600;
  double damping_Ns_per_m = 0;
  int steps_per_tick = 30;
  int max_exit_steps = 10;
  bool velocity_estimate = true;
  double max_prediction_s = 0.1;
  bool growth_is_motion = true;
  StepRule step_rule = StepRule::variable;
  double fixed_step_m = 1e-4;
  FreeRoot free_root = FreeRoot::ahead;
  ContactMotion contact_motion = ContactMotion::tangent_plane;
  ExitRule exit_rule = ExitRule::towards_hip;
  VelocityForce velocity_force = VelocityForce::minus;
  DampingSign damping_sign = DampingSign::plus;
  ForceGate force_gate = ForceGate::latest_contact;
  SlaveCommand slave_command = SlaveCommand::rendered;
  bool slave_prediction = false;  // not in the dissertation

  // The contact point lies in the middle of the contact region, 4.2.1.
  double contact_radius_m() const { return 0.5 * (r1_m + r2_m); }
};

Parameters parameters(ProxyParameters& p);
std::string validate(const ProxyParameters& p);
// Returns the list with r1, r2 and r3 fixed during a run, for methods that derive lengths from these radii.
Parameters with_fixed_radii(Parameters list);
// Returns an upper bound, over all poses, of how fast the magnitude of the force grows with the displacement
// of the HIP, N/m. It does not cover the damper, nor points that have a stiffness of their own.
inline double max_stiffness_N_per_m(const ProxyParameters& p) {
  return p.stiffness_N_per_m;
}
inline RenderedContact rendered_contact(const ProxyParameters& p) {
  return {p.contact_radius_m(), 0, p.contact_radius_m()};
}
// The settings of a method that has a proxy.
template <class Settings>
concept HasProxy = requires(const Settings& s) {
  s.proxy.stiffness_N_per_m;
};
template <HasProxy Settings>
double max_stiffness_N_per_m(const Settings& s) {
  return max_stiffness_N_per_m(s.proxy);
}
template <HasProxy Settings>
RenderedContact rendered_contact(const Settings& s) {
  return rendered_contact(s.proxy);
}

// Returns the state of 4.2.1: entrenched below r1, contact from r1 to r2 (both included), free above r2.
ContactState classify(double nearest_distance_m, const ProxyParameters& p);

// Returns the unit vector of (4.1), or `previous` if the sum has no direction (no points, or symmetric ones).
Vec3 unit_normal(const ContactQuery& query, const Vec3& previous);

// Returns the free step (4.4), (4.9): towards the HIP, up to the first point met. u = HIP - P.
Vec3 free_step(Neighbourhood& near, const Vec3& p_W, const Vec3& u, const ProxyParameters& p);

// Returns the step (4.5), (4.10): along the normal, until no point entrenches the proxy. If the normal is
// zero, the step leads away from the HIP. If u is zero too, the step is zero.
Vec3 entrenched_step(const PointsView& points, const Kernels& kernels, const Vec3& p_W, const Vec3& normal,
                     const Vec3& u, const ProxyParameters& p);

// Returns the step (4.6), (4.7), (4.11), (4.12): in the tangent plane if the HIP is below it (u.n < 0), else
// straight to the HIP. (4.7) does not define d_k; here the rule of (4.11), (4.12) is applied to the length of
// u. If the exit rule is (5.17) and the HIP is neither below the plane nor at P, the step is r2 - r1 along
// the normal, which frees the proxy.
Vec3 contact_step(const Vec3& normal, const Vec3& u, const ProxyParameters& p);

// Returns the step that replaces contact_step() when each region limits the motion by itself. goal: the
// admissible_motion() for u. The step leads towards goal with the length of (4.11), (4.12), but only up to
// the first other point that it meets. If nothing is in the way (goal = u), it is the step of free motion.
Vec3 region_step(Neighbourhood& near, const Vec3& p_W, const Vec3& goal, const Vec3& u,
                 const ProxyParameters& p);

// Returns true if the proxy has converged. A proxy in contact has converged if the angle between -u and the
// normal is below theta, (4.8). A free proxy has converged if P is the HIP. An entrenched proxy has not.
bool has_converged(ContactState state, const Vec3& normal, const Vec3& u, const ProxyParameters& p);
// Returns the same for a goal from admissible_motion(): true if the angle between -u and the cone of the
// touching regions' normals is below theta. False if no goal was found.
bool has_converged(const std::optional<Vec3>& goal, const Vec3& u, const ProxyParameters& p);

// A cache of the steps of the proxy (4.2.3). On noisy points the proxy often moves in a cycle: it returns to
// exactly the same positions, tick after tick, while the HIP and the frame do not change.

// One step of the proxy, world frame.
struct KnownStep {
  Vec3 proxy_W;                  // position at which the step begins
  Vec3 normal_W;                 // (4.1) at this position; zero if it has no direction
  Vec3 motion_m = Vec3::Zero();  // (4.4) to (4.12)
  ContactState state;            // 4.2.1
  double stiffness_N_per_m;      // (5.8); NaN: the renderer's own
};

// A table of steps, each of which is found by the position at which it begins. The table is a cache: it may
// lose a step, which then has to be computed again.
class KnownSteps {
 public:
  KnownSteps();
  // Forgets all steps. Call it when the cloud or the settings change.
  void forget() { ++generation_; }
  // Forgets all steps if the HIP has another position than in the last call, compared bit for bit.
  void set_hip(const Vec3& hip_W);
  // Returns the step that begins at this position, compared bit for bit; null if the table does not hold it.
  // Valid until the next remember().
  const KnownStep* from(const Vec3& proxy_W) const;
  // Stores a step. It may replace a step that begins at another position.
  void remember(const KnownStep& step);

 private:
  struct Entry {
    std::uint64_t generation = 0;
    KnownStep step;
  };
  std::vector<Entry> entries_;
  std::uint64_t generation_ = 1;
  Vec3 hip_W_ = Vec3::Zero();
};

// Returns the way out of a union of regions that encloses the proxy, which is not in the dissertation: a
// position outside all regions (r_n >= r1), the end of the shortest of nine straight lines from p. One line
// leads along the normal. Four lead across it: towards u, away from u, and to both sides. Four lie halfway
// between the normal and these. No line leads against the normal, so the proxy stays on its side. If the
// normal is zero, the direction away from u replaces it; if u is zero too, an axis of the world replaces it.
// Returns nullopt if no line leaves all regions after kMaxExits of them.
//
// (5.11) chooses a new direction in every step and can move in circles, but a straight line leaves every
// region only once.
inline constexpr int kMaxExits = 32;
std::optional<Vec3> straight_exit(Neighbourhood& near, const Kernels& kernels, const Vec3& p_W,
                                  const Vec3& normal_W, const Vec3& u, const ProxyParameters& p);

// Returns r_f of the region that is nearest to p, or of the region in which p is deepest. If several are
// equally near, the smallest r_f is returned. Returns nullopt if there are no points.
std::optional<double> nearest_region_radius_m(const PointsView& points, const Vec3& p_W);

// Motion that enters none of the regions which the proxy touches: an alternative to the tangent plane of
// (5.16), whose normal (5.7) is a mean over regions.

// Returns the motion nearest to u among those that enter no region within r2 of p: the projection of u onto
// the cone of all s with n_i . s >= 0, n_i = (p - x_i) / |p - x_i|. It is u itself if no region is in the
// way. It is zero in a corner that holds p from all sides. Returns nullopt if the projection is not found
// within a bounded number of rounds. A point at p itself is skipped.
std::optional<Vec3> admissible_motion(const PointsView& points, const Vec3& p_W, const Vec3& u, double r2);

// Returns true if the mean normal, the unit vector normal_W, is not reliable, as in a crease. This is so if
// the direction away from some region within r2 of p deviates from normal_W by more than the angle that has
// this cosine. It is also true between the points of a flat surface, if they are far apart.
bool is_in_crease(const PointsView& points, const Vec3& p_W, const Vec3& normal_W, double r2, double cosine);

}  // namespace remote_touch
