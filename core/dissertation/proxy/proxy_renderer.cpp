#include "core/dissertation/proxy/proxy_renderer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <utility>

#include "core/dissertation/proxy/proxy_motion.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

Vec3 VirtualCoupling::force(const Vec3& u, double since_frame_s, const Vec3& velocity,
                            double stiffness_N_per_m, double ticks) {
  // The surface continues along v_hat between updates, and the proxy would continue with it. The term is
  // subtracted, because u = HIP - P.
  Vec3 u_hat = u;
  if (velocity_force_ == VelocityForce::minus) u_hat -= since_frame_s * velocity;
  if (velocity_force_ == VelocityForce::plus) u_hat += since_frame_s * velocity;

  const double length = u_hat.norm();
  const double rate = has_previous_ ? haptic_rate_hz_ * (length - previous_length_) / ticks : 0;
  previous_length_ = length;
  has_previous_ = true;
  if (!(length > contact_radius_m_)) return Vec3::Zero();
  const double spring = stiffness_N_per_m * (length - contact_radius_m_);
  const double damper = damping_Ns_per_m_ * rate;
  const double pull = damping_sign_ == DampingSign::plus ? spring + damper : spring - damper;
  return u_hat * (-pull / length);
}

namespace {

// A HIP farther away than this cannot be a hand's, and squares of its distances would be too inaccurate.
constexpr double kMaxHipDistance_m = 1e6;

}  // namespace

ProxyRenderer::ProxyRenderer(const ProxyParameters& parameters, double haptic_rate_hz, const Kernels& kernels)
    : p_(parameters),
      kernels_(kernels),
      haptic_rate_hz_(haptic_rate_hz),
      near_(parameters.r3_m, kernels),
      velocity_(parameters.max_prediction_s),
      coupling_(parameters, haptic_rate_hz) {
  assert(validate(parameters).empty());
}

// Stores the frame and returns true if it is newer than all before.
bool ProxyRenderer::take(const Frame& frame) {
  if (!order_.accept_if_newer(frame)) return false;
  replace_points(frame.points);
  frame_arrived_s_ = frame.arrives_s;
  return true;
}

void ProxyRenderer::replace_points(std::shared_ptr<const NeighbourSearch> points) {
  near_.set_points(std::move(points));
  known_steps_.forget();
  has_local_query_ = false;
  is_clear_ = false;
}

// Returns r_f of the region that the proxy touches. Empty without contact, or if growth counts as motion.
std::optional<double> ProxyRenderer::felt_radius_m() {
  if (p_.growth_is_motion || !in_contact_) return {};
  return nearest_region_radius_m(near_.around(proxy_W_).view(), proxy_W_);
}

void ProxyRenderer::on_frame(const Frame& frame) {
  const bool takes_it = is_newer(frame) && p_.velocity_estimate;
  const std::optional<double> before_m = takes_it ? felt_radius_m() : std::nullopt;
  if (!take(frame) || !p_.velocity_estimate) return;
  const std::optional<double> now_m = before_m ? felt_radius_m() : std::nullopt;
  displace(velocity_.on_frame(frame.captured_s, normal_W_));  // (4.3)
  if (now_m) velocity_.on_growth(*now_m - *before_m);
}

void ProxyRenderer::on_frame(const Frame& frame, const SurfaceMotion& motion) {
  if (!take(frame)) return;
  velocity_.on_measured(frame.captured_s, motion.velocity_m_per_s, motion.normal_W);
  displace(motion.displacement_m);
}

void ProxyRenderer::displace(const Vec3& displacement_m) {
  proxy_W_ += displacement_m;
  frame_correction_m_ += displacement_m;
  contact_proxy_W_ += displacement_m;
}

void ProxyRenderer::set_radii(double r1_m, double r2_m, double r3_m) {
  p_.r1_m = r1_m, p_.r2_m = r2_m, p_.r3_m = r3_m;
  near_.set_reach(r3_m);
  coupling_.set_contact_radius(p_.contact_radius_m());
  known_steps_.forget();
  has_local_query_ = false;
}

// Applies changed settings. The surface counts as at rest while the estimate is off, also for (4.15). When it
// is switched on again, the estimate starts from zero.
void ProxyRenderer::parameters_changed() {
  set_radii(p_.r1_m, p_.r2_m, p_.r3_m);
  is_clear_ = false;
  coupling_.release();  // or a change of settings would enter the next rate
  if (!p_.velocity_estimate) velocity_ = SurfaceVelocity(p_.max_prediction_s);
}

RenderOutput ProxyRenderer::step(const DeviceState& device, double time_s) {
  const Vec3& hip_W = device.position_W;
  RenderOutput out;
  out.proxy_W = proxy_W_, out.normal_W = normal_W_;
  out.slave_W = slave_W_;
  out.frame_index = order_.newest();
  out.frame_correction_m = std::exchange(frame_correction_m_, Vec3::Zero());
  if (!hip_W.allFinite() || hip_W.cwiseAbs().maxCoeff() > kMaxHipDistance_m) {
    // The proxy rests and the force is zero: a force from an unknown position would be a guess.
    coupling_.release();
    out.status = RenderStatus::device_not_finite;
    return out;
  }
  if (!placed_) proxy_W_ = hip_W, placed_ = true;
  if (order_.newest() >= 0) {
    out.steps = move(hip_W);
    if (near_.has_regions()) out.steps += leave_regions(hip_W);
    report(hip_W, out);
    out.force_N = render_force(hip_W, time_s, out);
    out.status = order_.status(out.status);
  } else {
    out.proxy_W = proxy_W_ = hip_W;
    out.nearest_distance_m = std::numeric_limits<double>::infinity();
    out.converged = true;
    out.status = RenderStatus::no_frame;
    clear_W_ = hip_W;
  }
  out.slave_W = slave_W_ = slave_command(hip_W, time_s);
  return out;
}

// Returns the state (4.2.1) and the normal (4.1) at the proxy, from one pass over the points around it. The
// result is kept while the proxy rests.
const ProxyRenderer::LocalQuery& ProxyRenderer::local_query() {
  if (has_local_query_ && proxy_W_ == query_position_W_) return local_query_;
  // The results are constructed in place. A copy would wait, in each step, until they are in the cache: a
  // processor cannot forward a stored number to a load that is wider than the store.
  const PointsView* const points = ::new (&local_query_.points) PointsView(near_.narrowed(proxy_W_).view());
  ::new (&local_query_.query) ContactQuery(query(*points, proxy_W_));
  local_query_.state = classify(local_query_.query.nearest, p_);
  query_position_W_ = proxy_W_;
  has_local_query_ = true;
  return local_query_;
}

// pre: the points are the present list of neighbours, because sum_grid() belongs to that list.
ContactQuery ProxyRenderer::query(const PointsView& points, const Vec3& p_W) const {
  const ProxyRegions regions{p_.r1_m, p_.r2_m, p_.r3_m, near_.sum_grid(), p_.stiffness_N_per_m};
  return kernels_.proxy.contact_query(points, p_W.data(), regions);
}

// Returns the step that begins at the proxy, without its motion.
KnownStep ProxyRenderer::state_at_proxy() {
  const LocalQuery& here = local_query();
  return {.proxy_W = proxy_W_,
          .normal_W = unit_normal(here.query, Vec3::Zero()),
          .state = here.state,
          .stiffness_N_per_m = stiffness(here.query)};
}

// Notes what the force (4.16) and the way out of regions need of the position at which a step begins.
void ProxyRenderer::note_state(const KnownStep& here) {
  if (!here.normal_W.isZero(0)) normal_W_ = here.normal_W;
  if (here.state == ContactState::contact) {
    in_contact_ = true;
    contact_proxy_W_ = proxy_W_;
    contact_stiffness_N_per_m_ = here.stiffness_N_per_m;
  }
  if (here.state != ContactState::entrenched) clear_W_ = proxy_W_, is_clear_ = true;
}

// Computes the motion of a step and keeps it for the next time that the proxy is here. A step from a position
// without a normal (4.1), or with the rule for creases, also depends on earlier steps and is not kept.
void ProxyRenderer::find_motion(KnownStep& here, const Vec3& u) {
  here.motion_m = next_step(local_query_, u);
  if (!here.normal_W.isZero(0) && p_.contact_motion != ContactMotion::creases) known_steps_.remember(here);
}

// Runs the proxy movement algorithm, 4.2.3, and returns the number of steps. It ends before its budget when a
// step leaves the proxy where it is, bit for bit, because every further step would do the same. A step that
// known_steps_ holds is not computed again.
int ProxyRenderer::move(const Vec3& hip_W) {
  known_steps_.set_hip(hip_W);
  bool touched = false;
  for (int k = 1; k <= p_.steps_per_tick; ++k) {
    const Vec3 u = hip_W - proxy_W_;
    const KnownStep* const known = known_steps_.from(proxy_W_);
    KnownStep here = known ? *known : state_at_proxy();  // the state of 4.2.1 and the normal (4.1)
    note_state(here);
    touched |= here.state != ContactState::free;
    if (stops_at_convergence_ && here.state == ContactState::contact &&
        has_converged(here.state, normal_W_, u, p_))  // (4.8)
      return k - 1;
    if (!known) find_motion(here, u);  // (4.4) to (4.12)
    velocity_.on_step(here.motion_m);  // (4.13)
    const bool arrives = here.state == ContactState::free && here.motion_m == u;
    const Vec3 moved = arrives ? hip_W : Vec3(proxy_W_ + here.motion_m);
    if (here.state == ContactState::free && moved == hip_W)
      in_contact_ = false;  // the proxy reaches the HIP freely
    const bool settled = moved == proxy_W_;
    proxy_W_ = moved;
    if (settled || k == p_.steps_per_tick) {
      if (!touched) in_contact_ = false;
      return k;
    }
  }
  return 0;
}

// Moves an entrenched proxy out of overlapping regions; not in the dissertation. A tick can end inside a
// region, because the way out of one region may end in another one, or because the budget of steps is used
// up. First up to max_exit_steps more steps of (5.11) are made. If the proxy is still entrenched, it returns
// to its last position outside all regions. If a newer frame has made that position invalid, the proxy leaves
// along a straight line, if there is one. Returns the number of steps of (5.11).
int ProxyRenderer::leave_regions(const Vec3& hip_W) {
  if (p_.max_exit_steps == 0) return 0;
  int steps = 0;
  for (; steps < p_.max_exit_steps && local_query().state == ContactState::entrenched; ++steps) {
    normal_W_ = unit_normal(local_query_.query, normal_W_);
    proxy_W_ += next_step(local_query_, hip_W - proxy_W_);
  }
  if (local_query().state != ContactState::entrenched) return steps;
  if (is_clear_)
    proxy_W_ = clear_W_;
  else if (const auto exit_W = straight_exit(near_, kernels_, proxy_W_, normal_W_, hip_W - proxy_W_, p_))
    proxy_W_ = *exit_W;
  has_local_query_ = false;  // the search may have replaced the list of neighbours of the query
  return steps;
}

// Returns true if the step in contact uses each touching region by itself, not the tangent plane. Updates
// in_crease_. The angle at which a crease begins is larger than the angle at which it ends, because the two
// rules would alternate otherwise.
bool ProxyRenderer::update_region_rule(const LocalQuery& here) {
  if (p_.contact_motion != ContactMotion::creases) return p_.contact_motion == ContactMotion::regions;
  constexpr double kMeets = 0.95630475596303544, kLeaves = 0.97437006478523525;  // cosines of 17, 13 degrees
  in_crease_ = is_in_crease(here.points, proxy_W_, unit_normal(here.query, normal_W_), p_.r2_m,
                            in_crease_ ? kLeaves : kMeets);
  return in_crease_;
}

Vec3 ProxyRenderer::next_step(const LocalQuery& here, const Vec3& u) {
  switch (here.state) {
    case ContactState::free:
      return free_step(near_, proxy_W_, u, p_);
    case ContactState::entrenched:
      return entrenched_step(here.points, kernels_, proxy_W_, normal_W_, u, p_);
    case ContactState::contact:
      break;
  }
  if (!update_region_rule(here)) return contact_step(normal_W_, u, p_);
  const Vec3 goal = admissible_motion(here.points, proxy_W_, u, p_.r2_m).value_or(Vec3::Zero());
  return region_step(near_, proxy_W_, goal, u, p_);
}

// Fills in the output for the position at the end of the tick. Also updates clear_W_ and, through
// update_region_rule(), in_crease_.
void ProxyRenderer::report(const Vec3& hip_W, RenderOutput& out) {
  const LocalQuery& here = local_query();
  out.proxy_W = proxy_W_;
  out.state = here.state;
  if (here.state != ContactState::entrenched) clear_W_ = proxy_W_;
  out.normal_W = unit_normal(here.query, normal_W_);
  out.surface_velocity_m_per_s = velocity_.m_per_s();
  // The list of neighbours reaches beyond r3 in some directions only, so a distance beyond r3 is not
  // reliable.
  out.nearest_distance_m =
      here.query.nearest <= p_.r3_m ? here.query.nearest : std::numeric_limits<double>::infinity();
  out.contact_count = static_cast<int>(here.query.touching_count);
  const Vec3 u = hip_W - proxy_W_;
  if (here.state == ContactState::contact && update_region_rule(here))
    out.converged = has_converged(admissible_motion(here.points, proxy_W_, u, p_.r2_m), u, p_);
  else
    out.converged = has_converged(here.state, out.normal_W, u, p_);
  if (here.state == ContactState::entrenched && out.normal_W.isZero(0))
    out.status = RenderStatus::degenerate_normal;
}

// Returns the commanded position of the slave robot. A frame shows the surface at the time of its capture, so
// slave_prediction adds the motion since then. The prediction assumes, like (4.15), that the surface
// continues along v_hat. A predicted position that lies in a region of the newest frame is not sent.
Vec3 ProxyRenderer::slave_command(const Vec3& hip_W, double time_s) {
  if (p_.slave_command == SlaveCommand::hip) return hip_W;
  if (!p_.slave_prediction || !in_contact_) return clear_W_;
  const double age_s = std::clamp(time_s - order_.captured_s(), 0.0, velocity_.horizon_s());
  const Vec3 ahead_W = clear_W_ + age_s * velocity_.vector();
  const ContactQuery there = query(near_.around(ahead_W).view(), ahead_W);
  has_local_query_ = false;  // the query ahead may have replaced the list of neighbours
  return classify(there.nearest, p_) == ContactState::entrenched ? clear_W_ : ahead_W;
}

Vec3 ProxyRenderer::render_force(const Vec3& hip_W, double time_s, const RenderOutput& out) {
  const double ticks = elapsed_ticks(std::exchange(force_time_s_, time_s), time_s, haptic_rate_hz_);
  const bool send =
      p_.force_gate == ForceGate::latest_contact ? in_contact_ : out.state == ContactState::contact;
  if (!send) {
    coupling_.release();
    return Vec3::Zero();
  }
  const Vec3 p_W = p_.force_gate == ForceGate::latest_contact ? contact_proxy_W_ : proxy_W_;
  // The time is bounded, because the surface cannot be assumed to continue if frames stop coming.
  const double since_frame_s = std::min(time_s - frame_arrived_s_, velocity_.horizon_s());
  const double k_s =
      std::isnan(contact_stiffness_N_per_m_) ? p_.stiffness_N_per_m : contact_stiffness_N_per_m_;
  return coupling_.force(hip_W - p_W, since_frame_s, velocity_.vector(), k_s, ticks);
}

// Returns (5.8) as a weighted mean over the points; NaN, the renderer's own stiffness, if the cloud has no
// column of k_s.
double ProxyRenderer::stiffness(const ContactQuery& query) const {
  return query.weight_sum > 0 ? query.stiffness_sum / query.weight_sum
                              : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace remote_touch
