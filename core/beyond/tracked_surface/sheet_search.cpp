#include "core/beyond/tracked_surface/sheet_tracker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/points/number_columns.h"

namespace remote_touch {
namespace {

constexpr double kReaches[] = {6, 12, 24, 40};  // contact radii
constexpr std::size_t kEnough = 40, kMinGathered = 4;

double gather_near(const NeighbourSearch& frame, const Vec3& p_W, double unit_m, const Kernels& kernels,
                   GatheredPoints& gathered) {
  double reach = 0;
  for (const double r : kReaches) {
    reach = r;
    gathered.clear();
    frame.gather({p_W, r * unit_m}, kernels, gathered);
    gathered.finish();
    if (gathered.size() >= kEnough) break;
  }
  return reach;
}

// Returns the unit normal (4.1) over a wide reach, with the Wendland function of the distance itself; zero if
// it is not determined. The terms are rounded, so that their sum does not depend on their order.
Vec3 wide_normal(const GatheredPoints& gathered, const Vec3& p_W, double reach_m) {
  Vec3 sum = Vec3::Zero();
  const PointsView all = gathered.view();
  for (std::size_t i = 0; i < gathered.size(); ++i) {
    const Vec3 away = (p_W - Vec3(all.x[i], all.y[i], all.z[i])) / reach_m;
    const double q = away.norm(), rest = 1 - q;
    if (!(q > 0) || rest <= 0) continue;
    const Vec3 term = away * (rest * rest * rest * rest * (4 * q + 1) / q);
    for (int k = 0; k < 3; ++k) sum[k] += std::nearbyint(term[k] * 0x1p30) * 0x1p-30;
  }
  const double length = sum.norm();
  return length > 1e-6 ? Vec3(sum / length) : Vec3::Zero();
}

// Fills the profile with the heights of the points around the foot of the perpendicular, in a circle that is
// wide enough to hold some. Returns the radius of the circle; 0 if it holds fewer than three points.
double profile_of_column(const PatchPoints& points, double half_range, HeightProfile& profile) {
  for (double radius = 2.5;; radius *= 1.4) {
    profile.clear(half_range);
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const PatchPlace p = points.place(i);
      if (p.u * p.u + p.v * p.v <= radius * radius) profile.add(p.h), ++count;
    }
    if (count >= 30 || 1.4 * radius > HeightMap::kHalf) return count >= 3 ? radius : 0;
  }
}

// Returns the height of the mode that is nearest to the height of the proxy. Small modes are ignored. NaN:
// none.
double nearest_mode(const HeightProfile& smooth, double proxy_height) {
  constexpr double kMinFraction = 0.4;
  const double min = kMinFraction * smooth.max();
  double mode = std::numeric_limits<double>::quiet_NaN(), nearest = std::numeric_limits<double>::infinity();
  for (int b = 1; b + 1 < smooth.bins(); ++b) {
    const double c = smooth.count(b);
    if (c < min || c < smooth.count(b - 1) || c < smooth.count(b + 1)) continue;
    const double distance = std::abs(proxy_height - smooth.centre(b));
    if (distance < nearest) nearest = distance, mode = smooth.centre(b);
  }
  return mode;
}

// Returns the plane of least squares through the residuals that are within reach of the plane `before`. It is
// only the mean height if there are few points.
SheetShift refined(const PatchPoints& points, const PatchPlace& proxy, const SheetShift& before,
                   double reach) {
  constexpr double kSteepest = 0.5, kMinPoints = 12;
  const auto [n, su, sv, se, uu, uv, vv, ue, ve] = points.sums_near(
      {proxy.u, proxy.v, kRegistrationReach, before.height, before.slope_u, before.slope_v, reach});
  if (n < 3) return before;
  const double mu = su / n, mv = sv / n, me = se / n;
  const double cuu = uu - n * mu * mu, cuv = uv - n * mu * mv, cvv = vv - n * mv * mv;
  const double cue = ue - n * mu * me, cve = ve - n * mv * me, det = cuu * cvv - cuv * cuv;
  SheetShift shift{me, 0, 0};
  if (n < kMinPoints || !(det > 0.05 * cuu * cvv)) return shift;
  shift.slope_u = std::clamp((cvv * cue - cuv * cve) / det, -kSteepest, kSteepest);
  shift.slope_v = std::clamp((cuu * cve - cuv * cue) / det, -kSteepest, kSteepest);
  shift.height = me - shift.slope_u * mu - shift.slope_v * mv;
  return shift;
}

}  // namespace

Parameters parameters(SheetSettings& s) {
  return {
      {"gate_m", &s.gate_m, 1e-4, 1, "search range around the predicted position of the sheet"},
      {"initial_gate_m", &s.initial_gate_m, 1e-4, 1,
       "search range for a new sheet, and for one not found within gate_m"},
      {"max_gate_m", &s.max_gate_m, 1e-4, 1, "maximum search range; a sheet not found within it is lost"},
      {"max_missed_frames", &s.max_missed_frames, 0, 100,
       "maximum number of successive frames without the sheet; after more, a proxy in contact is released"},
      {"denoise", &s.denoise, 0, 1, "remove the noise from the points of the sheet"},
  };
}

std::string validate(const SheetSettings& s) {
  const auto line = [](const char* name, double value, const char* other, double min) {
    return std::string(name) + " = " + std::to_string(value) + ": expected at least " + other + " = " +
           std::to_string(min);
  };
  if (s.initial_gate_m < s.gate_m) return line("initial_gate_m", s.initial_gate_m, "gate_m", s.gate_m);
  if (s.max_gate_m < s.initial_gate_m)
    return line("max_gate_m", s.max_gate_m, "initial_gate_m", s.initial_gate_m);
  return {};
}

std::optional<FoundSheet> find_sheet(const NeighbourSearch& frame, const Vec3& proxy_W,
                                     double contact_radius_m, const Kernels& kernels,
                                     const AcquisitionBuffers& buffers) {
  const double reach = gather_near(frame, proxy_W, contact_radius_m, kernels, buffers.gathered);
  if (buffers.gathered.size() < kMinGathered) return {};
  Vec3 normal = wide_normal(buffers.gathered, proxy_W, reach * contact_radius_m);
  if (normal.isZero(0)) return {};
  FoundSheet found;
  PatchPoints& points = buffers.points;
  Vec3 foot_W = proxy_W;
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    found.frame = PatchFrame(foot_W, normal, contact_radius_m);
    points.set_points(buffers.gathered, {found.frame, HeightMap::kHalf, reach});
    HeightProfile profile;
    const double radius = profile_of_column(points, reach, profile);
    if (!(radius > 0)) return {};
    const HeightProfile smooth =
        profile.smoothed(round == 0 ? 0.3 : std::max(0.2, 0.5 * found.sigma.value_or(0)));
    const double mode = nearest_mode(smooth, found.frame.place(proxy_W).h);
    if (!std::isfinite(mode)) return {};
    const double top = mode + smooth.valley_from(mode, 1), bottom = mode - smooth.valley_from(mode, -1);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const PatchPlace p = points.place(i);
      points.set_member(i, p.u * p.u + p.v * p.v <= radius * radius && p.h < top && p.h > bottom);
    }
    buffers.fit.set_points(points);
    const PlaneFit plane = buffers.fit.plane_around(0, 0, radius);
    if (const double noise = buffers.fit.noise(); !std::isnan(noise)) found.sigma = noise;
    found.known = radius;
    if (!plane.valid) return {};
    const double steep = std::hypot(plane.slope_u, plane.slope_v);
    if (round + 1 == kRounds && steep > 1) return {};
    const double keep = steep > 1 ? 1 / steep : 1;
    normal = found.frame.normal_W(keep * plane.slope_u, keep * plane.slope_v);
    const Vec3 on_it_W = found.frame.world({0, 0, plane.height});
    foot_W = proxy_W - (proxy_W - on_it_W).dot(normal) * normal;
  }
  found.frame = PatchFrame(foot_W, normal, contact_radius_m);
  return found;
}

SheetShift register_sheet(const PatchPoints& points, const HeightProfile& profile, const PatchPlace& proxy,
                          double gate, double half_range, double sigma) {
  const HeightProfile now =
      points.profile_near(proxy, kRegistrationReach, half_range).smoothed(std::max(0.3, sigma));
  SheetShift shift{profile.shift_of(now, gate), 0, 0};
  for (const double narrow : {1.0, 0.5, 0.5})
    shift = refined(points, proxy, shift, std::max(narrow, 3 * sigma));
  return shift;
}

void SheetSearch::reserve(std::size_t points, bool with_radius, bool with_stiffness) {
  for (Columns* c : {&added_, &sorted_}) {
    c->x.grow(points, count_), c->y.grow(points, count_), c->z.grow(points, count_);
    c->index.grow(points, count_);
    if (with_radius) c->radius.grow(points, frame_ && has_fixture_radius() ? count_ : 0);
    if (with_stiffness) c->stiffness.grow(points, frame_ && has_stiffness() ? count_ : 0);
  }
  cell_of_.grow(points);
}

void SheetSearch::start(const PatchRegion& region, std::shared_ptr<const NeighbourSearch> frame,
                        std::shared_ptr<GatheredPoints> buffer) {
  region_ = region;
  frame_ = std::move(frame), buffer_ = std::move(buffer);
  count_ = 0;
}

int SheetSearch::cell_along(double coordinate) const {
  const double cell = (coordinate + region_.radius) * (kCells / (2 * region_.radius));
  return static_cast<int>(std::clamp(cell, 0.0, kCells - 1.0));
}

void SheetSearch::add(const PatchPlace& place, const GatheredPoints& gathered, std::size_t row) {
  const Vec3 p_W = region_.frame.world(place);
  const PointsView all = gathered.view();
  added_.x[count_] = p_W.x(), added_.y[count_] = p_W.y(), added_.z[count_] = p_W.z();
  added_.index[count_] = gathered.index()[row];
  if (all.radius) added_.radius[count_] = all.radius[row];
  if (all.stiffness) added_.stiffness[count_] = all.stiffness[row];
  cell_of_[count_++] = static_cast<std::uint32_t>(cell_along(place.v) * kCells + cell_along(place.u));
}

void SheetSearch::finish() {
  decltype(start_) next;
  const auto place = [this](std::size_t i, std::uint32_t to) {
    sorted_.x[to] = added_.x[i], sorted_.y[to] = added_.y[i], sorted_.z[to] = added_.z[i];
    sorted_.index[to] = added_.index[i];
    if (has_fixture_radius()) sorted_.radius[to] = added_.radius[i];
    if (has_stiffness()) sorted_.stiffness[to] = added_.stiffness[i];
  };
  sort_by_cell(
      count_, start_, next, [this](std::size_t i) { return cell_of_[i]; }, place);
}

void SheetSearch::gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const {
  if (!ball.centre.allFinite()) return;
  const Ball wide{ball.centre, ball.radius + max_fixture_radius_m()};
  // Points are sorted by their rounded positions, so the reach has a margin.
  const PatchPlace c = region_.frame.place(ball.centre);
  const double reach = wide.radius / region_.frame.unit_m() + 0x1p-10;
  const int first = cell_along(c.u - reach), last = cell_along(c.u + reach);
  for (int row = cell_along(c.v - reach); row <= cell_along(c.v + reach); ++row) {
    const std::uint32_t begin = start_[static_cast<std::size_t>(row * kCells + first)],
                        end = start_[static_cast<std::size_t>(row * kCells + last + 1)];
    if (begin == end) continue;
    out.add({sorted_.x.data() + begin, sorted_.y.data() + begin, sorted_.z.data() + begin,
             has_fixture_radius() ? sorted_.radius.data() + begin : nullptr,
             has_stiffness() ? sorted_.stiffness.data() + begin : nullptr, sorted_.index.data() + begin, 0,
             end - begin},
            ball, kernels);
  }
  if (region_.holds(wide)) return;
  buffer_->clear();
  frame_->gather(ball, kernels, *buffer_);
  buffer_->finish();
  const PointsView all = buffer_->view();
  for (std::size_t i = 0; i < buffer_->size(); ++i) {
    if (region_.holds(region_.frame.place(Vec3(all.x[i], all.y[i], all.z[i])))) continue;
    out.add({all.x + i, all.y + i, all.z + i, has_fixture_radius() ? all.radius + i : nullptr,
             has_stiffness() ? all.stiffness + i : nullptr, buffer_->index() + i, 0, 1},
            ball, kernels);
  }
}

}  // namespace remote_touch
