// One step of the proxy movement algorithm, 4.2.3 and 4.2.4 (chapter 5: the same with r_n and r_f).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/kernels/proxy_kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/neighbour_search.h"
#include "core/points/vector.h"
#include "core/rendering/renderer.h"

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

}  // namespace remote_touch
