#include "core/beyond/tracked_surface/sheet_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/beyond/tracked_surface/height_fit.h"
#include "core/kernels/depth_kernels.h"

namespace remote_touch {

namespace {

// Lengths are in contact radii.
constexpr double kNoisePart = 3.5;  // points farther from a sheet than this many sigma are not its noise
constexpr double kThinnest = 0.5;   // half thickness of a sheet without noise
constexpr double kLost = 0.2, kDoubtful = 0.5;  // shares of members to find: at the widest gate; at others
constexpr double kMiddle = 5;  // radius of the middle, in which the patch shows all that the proxy touches
constexpr double kResolution = 0x1p-12;  // resolution of positions: a smaller motion counts as none
constexpr double kTouching = 2.5;        // a pressing proxy farther away is held by another surface

double half_thickness(double sigma) {
  return std::max(kThinnest, kNoisePart * sigma);
}

}  // namespace

SheetTracker::SheetTracker(const SheetSettings& settings, double contact_radius_m, const Kernels& kernels,
                           Shows shows)
    : s_(settings), unit_m_(contact_radius_m), kernels_(kernels), shows_(shows), points_(kernels) {}

void SheetTracker::reserve(std::size_t points, bool with_radius, bool with_stiffness) {
  points_.reserve(points);
  sheet_.reserve(points);
  gathered_->reserve(points, with_radius, with_stiffness);
  if (shows_ == Shows::points) return;
  buffer_->reserve(points, true, true);  // the columns of the shown frame may differ from those of the newest
  for (auto& search : shown_) search->reserve(points, with_radius, with_stiffness);
}

void SheetTracker::reserve_for_newest() {
  reserve(newest_->size(), newest_->has_fixture_radius(), newest_->has_stiffness());
}

// Returns the half height of the region that is searched, without the gate.
double SheetTracker::half_height() const {
  return std::max(4.0, 2 + kNoisePart * sigma_);
}

void SheetTracker::gather(double half_height) {
  region_.half_height = half_height;
  gathered_->clear();
  newest_->gather(region_.around(), kernels_, *gathered_);
  gathered_->finish();
  points_.set_points(*gathered_, region_);
}

void SheetTracker::forget() {
  age_ = missed_ = 0;
  before_.known = keeps_normal_ = false;
  shift_ = shift_before_ = 0;
  sheet_.clear();
}

// Builds the map from the middle of the patch outwards.
void SheetTracker::grow(const PatchFrame& frame, double known, const Vec3& proxy_W) {
  region_ = {frame, HeightMap::kHalf, 0};
  gather(half_height());
  map_.set_plane(0, 0, 0, known + 1);
  for (int ring = 0; ring < 4; ++ring) {
    map_.extend(3);
    find_members(patch().place(proxy_W));
    fit_map(1);
  }
}

void SheetTracker::restart(const Vec3& proxy_W) {
  forget();
  const auto found = find_sheet(*newest_, proxy_W, unit_m_, kernels_, {*gathered_, points_, fit_});
  tracks_ = found.has_value();
  if (!tracks_) return;
  if (found->sigma) sigma_ = *found->sigma;
  grow(found->frame, found->known, proxy_W);
}

void SheetTracker::begin(const Vec3& foot_W, const Vec3& normal_W, double sigma) {
  constexpr double kKnown = 2;
  forget();
  tracks_ = keeps_normal_ = true;
  sigma_ = sigma;
  const Vec3 proxy_W = foot_W + unit_m_ * normal_W;
  grow(PatchFrame(foot_W, normal_W, unit_m_), kKnown, proxy_W);
  show(proxy_W);
}

// Returns true if the hand moved to another surface, or if the tracked sheet is not the one that holds the
// proxy.
bool SheetTracker::is_of_other_surface(const ProxyPosition& proxy) const {
  const PatchPlace p = patch().place(proxy.p_W);
  if (!(p.u * p.u + p.v * p.v < region_.radius * region_.radius)) return true;
  const double clearance = p.h - map_.height(p.u, p.v);
  if (!std::isfinite(clearance) || clearance < -0.5) return true;
  if (proxy.pressing) return clearance > kTouching + contact_distance(p) - 1;
  return !map_.covers(p.u, p.v) || nearer_stray_;
}

// Rebuilds the map around another middle, or along another normal, from the members of the previous frame.
void SheetTracker::recentre(const Vec3& middle_W) {
  constexpr double kOff = 1.5, kSteep = 0.2, kTooSteep = 2;
  const PatchPlace p = patch().place(middle_W);
  if (!(p.u * p.u + p.v * p.v < region_.radius * region_.radius)) return;
  const double height = map_.height(p.u, p.v);
  const HeightMap::Slopes slopes = map_.mean_slopes(p.u, p.v, kMiddle);
  const double steep = std::hypot(slopes.u, slopes.v);
  if (!std::isfinite(height + steep)) return;
  if (p.u * p.u + p.v * p.v < kOff * kOff && (steep < kSteep || keeps_normal_)) return;
  const PatchFrame before = patch();
  const bool turns = steep < kTooSteep && !keeps_normal_;
  const Vec3 normal_W = turns ? before.normal_W(slopes.u, slopes.v) : before.normal_W();
  region_.frame = PatchFrame(before.world({p.u, p.v, height}), normal_W, unit_m_);
  points_.clear();
  for (PatchPlace& q : sheet_) q = patch().place(before.world(q));
  std::erase_if(sheet_, [&](const PatchPlace& q) {
    return !(q.u * q.u + q.v * q.v < region_.radius * region_.radius);
  });
  for (const PatchPlace& q : sheet_) points_.add(q, true);
  fit_.set_points(points_, fit_trend(points_, std::max(0.3 * sigma_, kUntouched)));
  fit_.fit(0.3 * sigma_, map_);
}

// Moves the origin back onto a sheet that has moved away from it without being predicted, before the sheet
// leaves the region.
void SheetTracker::level() {
  constexpr double kFar = 2;
  const double height = PatchFrame::rounded(map_.height(0, 0));
  if (!(std::abs(height) > kFar)) return;
  region_.frame.move_along_normal(height);
  map_.add_plane(-height, 0, 0);
  for (PatchPlace& q : sheet_) q.h -= height;
}

// Predicts the next shift from the last two. Their difference is used only as far as noise does not explain
// it.
double SheetTracker::predicted_shift(double interval_s) const {
  if (age_ == 0 || !(interval_s_ > 0)) return 0;
  const double ratio = interval_s / interval_s_;
  const double change = age_ >= 2 ? shift_ - shift_before_ : 0;
  return shift_ * ratio + shrunk(change, 1.5 * shift_error_) * ratio * ratio;
}

// Selects the points that belong to the sheet that the map predicts: they are within its noise and nearer to
// it than to another sheet. Returns their number.
double SheetTracker::find_members(const PatchPlace& proxy) {
  points_.set_residuals(map_);
  const HeightProfile smooth = points_.profile_near(proxy, kRegistrationReach, region_.half_height)
                                   .smoothed(std::max(0.2, 0.5 * sigma_));
  const double max = half_thickness(sigma_);
  up_ = std::min(max, smooth.valley_from(0, 1)), down_ = std::min(max, smooth.valley_from(0, -1));
  double count = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const bool is_member = points_.residual(i) <= up_ && points_.residual(i) >= -down_;  // false for NaN
    points_.set_member(i, is_member);
    count += is_member;
  }
  return count;
}

// Keeps sigma_ if there are too few points to measure the noise.
void SheetTracker::fit_map(double weight_of_new_noise) {
  fit_.set_points(points_, fit_trend(points_, std::max(sigma_, kUntouched)));
  fit_.fit(sigma_, map_);
  const double noise = fit_.noise();
  if (!std::isnan(noise)) sigma_ += weight_of_new_noise * (noise - sigma_);
}

// Finds the sheet in the newest frame. Returns false if it is not found.
bool SheetTracker::follow(const Vec3& proxy_W) {
  const double before = static_cast<double>(sheet_.size());
  const double first = age_ >= 1 ? s_.gate_m : s_.initial_gate_m;
  double tried_m = 0;
  for (const double gate_m : {first, s_.initial_gate_m, s_.max_gate_m}) {
    if (gate_m <= tried_m) continue;
    tried_m = gate_m;
    const double gate = gate_m / unit_m_;
    gather(half_height() + gate);
    const PatchPlace proxy = patch().place(proxy_W);
    points_.set_residuals(map_);
    const SheetShift shift = register_sheet(points_, profile_, proxy, gate, region_.half_height, sigma_);
    const HeightMap before_it = map_;
    map_.add_plane(shift.height, shift.slope_u, shift.slope_v);
    map_.extend(2);
    const double found = find_members(proxy);
    if (found >= kDoubtful * before || (gate_m >= s_.max_gate_m && found >= kLost * before && found >= 3)) {
      fit_map(age_ >= 1 ? 0.4 : 1);
      if (shows_ == Shows::points && age_ >= 1 && changes_points()) map_.shrink_change_since(before_it);
      return true;
    }
    map_ = before_it;
  }
  return false;
}

// Returns the distance at which a resting proxy is kept from the sheet: r_c + r_f, in contact radii.
double SheetTracker::contact_distance(const PatchPlace& proxy) const {
  if (missed_ > 0) return pressed_distance_;
  const PointsView all = gathered_->view();
  if (!all.radius) return 1;
  double nearest = 4, radius = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!points_.is_member(i)) continue;
    const PatchPlace p = points_.place(i);
    const double du = p.u - proxy.u, dv = p.v - proxy.v, d2 = du * du + dv * dv;
    const double r = all.radius[points_.source(i)] / unit_m_;
    if (d2 < nearest || (d2 == nearest && r > radius)) nearest = d2, radius = r;
  }
  return 1 + radius;
}

std::shared_ptr<const NeighbourSearch> SheetTracker::keep(std::shared_ptr<const NeighbourSearch> frame) {
  newest_ = std::move(frame);
  reserve_for_newest();
  tracks_ = before_.known = false;
  return newest_;
}

double SheetTracker::clearance(const Vec3& p_W) const {
  const PatchPlace p = patch().place(p_W);
  return p.h - map_.height(p.u, p.v);
}

double SheetTracker::moved(const Vec3& p_W) const {
  if (!before_.known) return std::numeric_limits<double>::quiet_NaN();
  const PatchPlace p = before_.frame.place(p_W);
  const double moved = p.h - before_.map.height(p.u, p.v) - clearance(p_W);
  return std::abs(moved) <= kResolution ? 0 : moved;
}

double SheetTracker::moved_error(const Vec3& p_W) const {
  const PatchPlace p = patch().place(p_W);
  return error_of_two(map_.error(p.u, p.v));
}

ShownPoint SheetTracker::shown(const Vec3& p_W) const {
  using enum ShownPoint::Kind;
  ShownPoint shown;
  const PatchPlace p = patch().place(p_W);
  if (!region_.holds(p)) return shown;
  shown.residual = p.h - map_.height(p.u, p.v);
  if (!(shown.residual <= up_ && shown.residual >= -down_)) {  // true for NaN
    shown.kind = strays_.is_surface(p) ? surface : stray;
    return shown;
  }
  const double max = kNoisePart * sigma_,
               inside = 1 - (p.u * p.u + p.v * p.v) / (region_.radius * region_.radius);
  const HeightMap::Slopes slopes = map_.slopes(p.u, p.v);
  shown.kind = sheet;
  shown.p_W = patch().world({p.u, p.v, PatchFrame::rounded(p.h - std::clamp(shown.residual, -max, max))});
  shown.normal_W = patch().normal_W(slopes.u, slopes.v);
  shown.weight = inside * inside;
  return shown;
}

// Returns the distance by which the proxy must move along the normal to leave the sheet. Denoised points have
// other positions when the patch has moved, so the proxy may be inside the sheet.
double SheetTracker::exit_distance(const Vec3& proxy_W) const {
  const PatchPlace p = patch().place(proxy_W);
  const double now = clearance(proxy_W);
  if (!changes_points() || !map_.covers(p.u, p.v) || !std::isfinite(now)) return 0;
  return std::max(0.0, contact_distance(p) - now);
}

// Returns the displacement of the proxy along the normal, in contact radii. A proxy that the sheet holds back
// keeps its clearance. A free proxy is moved only out of a sheet that swept over it, and no farther than the
// sheet moved.
double SheetTracker::proxy_displacement(const ProxyPosition& proxy, double clearance_before) const {
  const double now = clearance(proxy.p_W), moved = clearance_before - now;
  if (!(std::abs(moved) > kResolution)) return 0;
  if (proxy.pressing) return moved;
  const PatchPlace p = patch().place(proxy.p_W);
  return map_.covers(p.u, p.v) ? std::clamp(contact_distance(p) - now, 0.0, std::max(0.0, moved)) : 0;
}

// Searches for a new sheet. Its motion is 0, because it was not seen before.
SheetUpdate SheetTracker::reacquire(const Vec3& proxy_W) {
  restart(proxy_W);
  return {show(proxy_W), Vec3::Zero(), 0, Vec3::Zero()};
}

SheetUpdate SheetTracker::on_frame(std::shared_ptr<const NeighbourSearch> frame, const ProxyPosition& proxy,
                                   double interval_s) {
  const Vec3 ahead = last_proxy_W_ ? Vec3(0.5 * (proxy.p_W - *last_proxy_W_)) : Vec3::Zero();
  last_proxy_W_ = proxy.p_W;
  // These are values of the previous frame, whose points are still stored.
  const bool continues = tracks_ && !is_of_other_surface(proxy);
  const double held = continues ? contact_distance(patch().place(proxy.p_W)) : 1;
  newest_ = std::move(frame);
  reserve_for_newest();
  if (!continues) return reacquire(proxy.p_W);
  recentre(ahead.norm() < kMiddle * unit_m_ ? Vec3(proxy.p_W + ahead) : proxy.p_W);
  level();
  const double before = clearance(proxy.p_W);
  const PatchFrame unmoved = patch();
  before_.frame = unmoved, before_.map = map_, before_.known = false;
  region_.frame.move_along_normal(predicted_shift(interval_s));
  if (!follow(proxy.p_W)) {
    if (!proxy.pressing || ++missed_ > s_.max_missed_frames) return reacquire(proxy.p_W);
    region_.frame = unmoved;
    pressed_distance_ = held;
    return {nullptr, Vec3::Zero(), 0, Vec3::Zero()};
  }
  missed_ = 0;
  before_.known = true;
  SheetUpdate update;
  update.displacement_m = proxy_displacement(proxy, before) * unit_m_ * patch().normal_W();
  update.normal_W = patch().normal_W();
  update.velocity_m_per_s = velocity(proxy.p_W, before, interval_s);
  update.points = show(proxy.p_W + update.displacement_m);
  return update;
}

// Computes the velocity of the sheet, m/s, from the change of the clearance of a resting point.
double SheetTracker::velocity(const Vec3& proxy_W, double clearance_before, double interval_s) {
  double moved = clearance_before - clearance(proxy_W);
  if (!std::isfinite(moved) || !(interval_s > 0)) return 0;
  if (std::abs(moved) <= kResolution) moved = 0;
  const PatchPlace p = patch().place(proxy_W);
  shift_before_ = age_ >= 1 ? shift_ : moved;
  shift_ = moved;
  shift_error_ = error_of_two(map_.error(p.u, p.v));
  interval_s_ = interval_s;
  ++age_;
  return shrunk(shift_, shift_error_) * unit_m_ / interval_s;
}

bool SheetTracker::must_requery(const Vec3& proxy_W) const {
  if (!newest_ || missed_ > 0) return false;  // a missing sheet cannot be queried
  if (!tracks_) return (proxy_W - query_position_W_).norm() > unit_m_;
  const double near_m = 0.999 * kMiddle * unit_m_;  // distances along the patch are at most those in space
  if ((proxy_W - patch().origin_W()).squaredNorm() < near_m * near_m) return false;
  const PatchPlace p = patch().place(proxy_W);
  return !(p.u * p.u + p.v * p.v < kMiddle * kMiddle);
}

SheetUpdate SheetTracker::requery(const ProxyPosition& proxy) {
  if (!tracks_ || is_of_other_surface(proxy)) return reacquire(proxy.p_W);
  before_.known = false;
  recentre(proxy.p_W);
  level();
  gather(half_height());
  map_.extend(6);
  find_members(patch().place(proxy.p_W));
  fit_map(0.4);
  SheetUpdate update;
  update.displacement_m = exit_distance(proxy.p_W) * unit_m_ * patch().normal_W();
  update.points = show(proxy.p_W + update.displacement_m);
  return update;
}

// Shows the members without their noise, and the other points that belong to a surface. Stray points are left
// out.
std::shared_ptr<const NeighbourSearch> SheetTracker::show(const Vec3& proxy_W) {
  query_position_W_ = proxy_W;
  nearer_stray_ = false;
  sheet_.clear();
  if (!tracks_) return newest_;
  const bool clean = !changes_points() || shows_ == Shows::points;
  const PatchPlace proxy = patch().place(proxy_W);
  const double max = kNoisePart * sigma_;
  SheetSearch& shown = *shown_[present_ ^= 1];
  if (!clean) shown.start(region_, newest_, buffer_);
  points_.set_residuals(map_);
  profile_ = points_.profile_near(proxy, kRegistrationReach, region_.half_height + 2).smoothed(0.1);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!points_.is_member(i) || !std::isfinite(points_.residual(i))) continue;
    PatchPlace p = points_.place(i);
    p.h = PatchFrame::rounded(p.h - std::clamp(points_.residual(i), -max, max));
    sheet_.push_back(p);
    if (!clean) shown.add(p, *gathered_, points_.source(i));
  }
  strays_.count(points_, region_, sigma_, fit_.typical_density());
  const double clearance = proxy.h - map_.height(proxy.u, proxy.v);
  double nearest = 0.7 * clearance;
  nearest = nearest > 0 ? nearest * nearest : 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (points_.is_member(i)) continue;
    const PatchPlace p = points_.place(i);
    if (!strays_.is_surface(p)) continue;
    if (!clean) shown.add(p, *gathered_, points_.source(i));
    const double du = p.u - proxy.u, dv = p.v - proxy.v, dh = p.h - proxy.h;
    nearer_stray_ |= du * du + dv * dv + dh * dh < nearest;
  }
  if (clean) return newest_;
  shown.finish();
  return {shown_[present_], &shown};
}

}  // namespace remote_touch
