#include "core/beyond/tracked_surface/sheet_patches.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/beyond/tracked_surface/height_fit.h"

namespace remote_touch {
namespace {

// Stores for every point the squared distance to the nearest chosen point.
class FarthestPoints {
 public:
  explicit FarthestPoints(std::span<const Vec3> points)
      : points_(points),
        nearest_(points.size(), std::numeric_limits<double>::infinity()),
        of_(points.size(), 0) {}
  void choose(std::size_t point) {
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (const double d = (points_[i] - points_[point]).squaredNorm(); d < nearest_[i])
        nearest_[i] = d, of_[i] = count_;
    ++count_;
  }
  std::size_t farthest() const {
    return static_cast<std::size_t>(std::ranges::max_element(nearest_) - nearest_.begin());
  }
  double squared_distance(std::size_t point) const { return nearest_[point]; }
  std::size_t chosen_for(std::size_t point) const { return of_[point]; }

 private:
  std::span<const Vec3> points_;
  std::vector<double> nearest_;
  std::vector<std::size_t> of_;
  std::size_t count_ = 0;
};

using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Converts a motion (t, lever w) of a body about one position to the same motion about another, `by` away
// from it.
Matrix6 transport(const Vec3& by, double lever_m) {
  Matrix6 m = Matrix6::Identity();  // t' = t + w x by
  m.block<3, 3>(0, 3) << 0, by.z(), -by.y(), -by.z(), 0, by.x(), by.y(), -by.x(), 0;
  m.block<3, 3>(0, 3) /= lever_m;
  return m;
}

// Lengths are in units of the patches (contact radii) unless the name has another unit.
constexpr double kGroupRadius = 6.5;  // largest radius of a group of positions on the tool
constexpr double kShownBeyond = 0.8;  // points up to this distance from the tool must be in the patch
constexpr double kMinReach = 1, kMaxReach = 5, kContactReach = 3;  // motion until patches are updated
constexpr double kOnSheet = 0.5;         // largest distance of a contact from its sheet
constexpr double kAlike = 0.7;           // minimum cosine between the normals of a contact and of its sheet
constexpr double kSameDirection = 0.95;  // minimum cosine between the normals of contacts with one face
constexpr int kEnoughAlike = 3;
constexpr double kSameSheet = 0.85;  // minimum cosine between the normals of patches of one sheet
constexpr double kLeft = 2;          // clearance of the tool at which the patch of a contact ends
constexpr double kNearlyAsLow = 0.5;
constexpr double kBehind = -0.5;      // a position deeper than this was not in front of the sheet
constexpr double kLever = 2;          // see CarriedMotion
constexpr double kTouching_m = 5e-4;  // contacts farther from the tool do not hold it

Vec3 world(const ToolPose& pose, const Vec3& p_T) {
  return pose.p_W + pose.q_WT * p_T;
}

}  // namespace

ToolPositions::ToolPositions(const TriangleMesh& mesh, double group_radius_m, std::size_t max_groups) {
  assert(!mesh.vertices.empty() && group_radius_m > 0 && max_groups > 0);
  const double spacing_m = 0.125 * group_radius_m;
  const std::vector<Vec3> points = surface_points(mesh, spacing_m);
  FarthestPoints spread(points);
  for (std::size_t next = 0; positions_T_.size() < kMax; next = spread.farthest()) {
    positions_T_.push_back(points[next]);
    spread.choose(next);
    if (spread.squared_distance(spread.farthest()) <= spacing_m * spacing_m) break;
  }
  for (std::size_t groups = 1; groups <= max_groups; ++groups) {
    divide(groups);
    double widest_m = 0;
    for (const Group& group : groups_) widest_m = std::max(widest_m, group.radius_m);
    if (widest_m <= group_radius_m) break;
  }
}

// Divides the positions into groups around positions that are far from each other.
void ToolPositions::divide(std::size_t groups) {
  FarthestPoints seeds(positions_T_);
  std::size_t seed = 0;
  for (std::size_t g = 0; g < groups; ++g, seed = seeds.farthest()) seeds.choose(seed);
  std::vector<Vec3> sorted;
  groups_.clear();
  for (std::size_t g = 0; g < groups; ++g) {
    Group group;
    group.first = sorted.size();
    BoundingBox box;
    for (std::size_t i = 0; i < positions_T_.size(); ++i)
      if (seeds.chosen_for(i) == g) sorted.push_back(positions_T_[i]), box.extend(positions_T_[i]);
    group.count = sorted.size() - group.first;
    if (group.count == 0) continue;
    group.middle_T = 0.5 * (box.min() + box.max());
    for (std::size_t i = group.first; i < sorted.size(); ++i)
      group.radius_m = std::max(group.radius_m, (sorted[i] - group.middle_T).norm());
    groups_.push_back(group);
  }
  positions_T_ = std::move(sorted);
}

void CarriedMotion::add(const CarriedPosition& position) {
  if (empty()) first_W_ = position.p_W;
  const Vec3 r = position.p_W - first_W_;
  Vector6 row;
  row << position.normal_W, r.cross(position.normal_W) / lever_m_;
  rows_ += position.weight * row * row.transpose();
  right_ += position.weight * position.moved_m * row;
  weight_ += position.weight;
  sum_m_ += position.weight * r;
  error_m_ += position.weight * position.error_m;
}

CarriedMotion::Result CarriedMotion::about(const Vec3& about_W, const Vector6& expected) const {
  Result result;
  if (empty()) return result;
  const Vec3 middle = sum_m_ / weight_;
  // Rows about the first position are converted to rows about the mean: row . x = row . T^-1 x'.
  const Matrix6 back = transport(-middle, lever_m_);
  const Matrix6 a = back.transpose() * rows_ * back / weight_;
  const Vector6 b = back.transpose() * right_ / weight_;
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(a);
  const Vec3 centre = about_W - first_W_ - middle;
  Vector6 before = expected;
  before.tail<3>() *= lever_m_;
  before = transport(-centre, lever_m_) * before;
  Vector6 x = Vector6::Zero(), shrunk_x = Vector6::Zero();
  for (int k = 0; k < 6; ++k) {
    const double value = eigen.eigenvalues()[k];
    if (!(value >= kObservable)) continue;
    const Vector6 axis = eigen.eigenvectors().col(k);
    const double along = axis.dot(b) / value, before_along = axis.dot(before);
    const double error_m = error_m_ / weight_ / std::sqrt(value);
    x += along * axis, shrunk_x += (before_along + shrunk(along - before_along, error_m)) * axis;
  }
  for (auto& [from, to] :
       {std::pair<const Vector6&, Vector6&>(x, result.motion), {shrunk_x, result.shrunk}}) {
    to = transport(centre, lever_m_) * from;
    to.tail<3>() /= lever_m_;
  }
  result.known = true;
  return result;
}

SheetPatches::SheetPatches(const SheetSettings& settings, double unit_m, std::size_t max_patches,
                           const VoxelTool& tool, const Kernels& kernels)
    : unit_m_(unit_m),
      positions_(tool.mesh, kGroupRadius * unit_m, max_patches),
      patches_(std::max(max_patches, positions_.groups().size())),
      shown_radius_m_(tool.reach_m + 2 * kMaxReach * unit_m) {
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    Patch& patch = patches_[i];
    patch.tracker = std::make_unique<SheetTracker>(settings, unit_m, kernels, SheetTracker::Shows::points);
    patch.of_group = patch.in_use = i < positions_.groups().size();
    patch.positions_T = positions_.all(), patch.reach_m = kContactReach * unit_m;
    if (!patch.of_group) continue;
    const ToolPositions::Group& group = positions_.groups()[i];
    patch.positions_T = positions_.of(group), patch.middle_T = group.middle_T;
    patch.reach_m = std::clamp((HeightMap::kHalf - kShownBeyond) * unit_m - group.radius_m,
                               kMinReach * unit_m, kMaxReach * unit_m);
  }
}

void SheetPatches::reserve(std::size_t points) {
  for (Patch& patch : patches_) patch.tracker->reserve(points, true, true);
}

void SheetPatches::keep(const std::shared_ptr<const NeighbourSearch>& frame, double captured_s) {
  for (Patch& patch : patches_)
    if (patch.in_use) patch.tracker->keep(frame), patch.captured_s = captured_s;
}

// --- the tool over a sheet ---

bool SheetPatches::explains(const Patch& patch, const Vec3& p_W, const Vec3& n_W) const {
  if (!patch.in_use || !patch.tracker->tracks()) return false;
  const PatchRegion& region = patch.tracker->region();
  const PatchPlace p = region.frame.place(p_W);
  const HeightMap::Slopes slopes = patch.tracker->map().slopes(p.u, p.v);
  return p.u * p.u + p.v * p.v < region.radius * region.radius &&
         std::abs(patch.tracker->clearance(p_W)) <= kOnSheet &&
         region.frame.normal_W(slopes.u, slopes.v).dot(n_W) >= kAlike;
}

SheetPatches::Lowest SheetPatches::lowest(const Patch& patch, const ToolPose& pose) const {
  const PatchRegion& region = patch.tracker->region();
  const HeightMap& map = patch.tracker->map();
  const auto each = [&](auto&& use) {
    for (const Vec3& p_T : patch.positions_T) {
      const Vec3 p_W = world(pose, p_T);
      const PatchPlace p = region.frame.place(p_W);
      if (p.u * p.u + p.v * p.v < region.radius * region.radius && map.covers(p.u, p.v))
        use(p_W, p.h - map.height(p.u, p.v));
    }
  };
  Lowest low;
  each([&](const Vec3& p_W, double clearance) {
    if (!low.found || clearance < low.clearance) low = {true, clearance, p_W};
  });
  Vec3 sum_W = Vec3::Zero();
  double count = 0;
  each([&](const Vec3& p_W, double clearance) {
    if (clearance <= low.clearance + kNearlyAsLow) sum_W += p_W, count += 1;
  });
  const PatchPlace mean = region.frame.place(sum_W / count);
  if (low.found && map.covers(mean.u, mean.v)) low.p_W = sum_W / count;
  return low;
}

// Returns the position of a patch's proxy. It is a contact radius above the lowest position on the tool, and
// over the middle of the group if the sheet is seen there.
ProxyPosition SheetPatches::proxy_position(const Patch& patch, const ToolPose& pose, bool held) const {
  ProxyPosition position{world(pose, patch.middle_T), holds(patch, held)};
  if (!patch.tracker->tracks()) return position;
  const Lowest low = lowest(patch, pose);
  if (!low.found) return position;
  const PatchFrame& frame = patch.tracker->region().frame;
  PatchPlace p = frame.place(position.p_W);
  if (!patch.of_group || !patch.tracker->map().covers(p.u, p.v)) p = frame.place(low.p_W);
  position.p_W = frame.world({p.u, p.v, patch.tracker->map().height(p.u, p.v) + low.clearance + 1});
  return position;
}

// Returns the index of the patch that explains a contact; -1 if none does.
int SheetPatches::patch_of(const ToolHold& hold, const ToolContact& contact) const {
  const Vec3 p_W = world(hold.pose, contact.r_T), n_W = hold.pose.q_WT * contact.n_T;
  double nearest = std::numeric_limits<double>::infinity();
  int of = -1;
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    if (!explains(patches_[i], p_W, n_W)) continue;
    const double distance = std::abs(patches_[i].tracker->clearance(p_W));
    if (distance < nearest) nearest = distance, of = static_cast<int>(i);
  }
  return of;
}

void SheetPatches::count_contacts(const ToolHold& hold) {
  for (Patch& patch : patches_) patch.contacts = 0;
  for (std::size_t k = 0; k < hold.contacts.size(); ++k) {
    patch_of_[k] = hold.contacts[k].depth_m >= -kTouching_m ? patch_of(hold, hold.contacts[k]) : -1;
    if (patch_of_[k] >= 0) ++patches_[static_cast<std::size_t>(patch_of_[k])].contacts;
  }
}

// Finds the deepest unexplained contact and counts the contacts with its direction. Contacts at an edge of
// the tool have directions between those of its faces, so a new patch needs several with the same direction.
void SheetPatches::count_unexplained(const ToolHold& hold) {
  unexplained_.alike = 0, unexplained_.depth_m = -kTouching_m;
  for (std::size_t k = 0; k < hold.contacts.size(); ++k) {
    const ToolContact& contact = hold.contacts[k];
    if (patch_of_[k] >= 0 || contact.depth_m < unexplained_.depth_m) continue;
    unexplained_ = {1, world(hold.pose, contact.r_T), hold.pose.q_WT * contact.n_T, contact.depth_m};
  }
  if (unexplained_.alike == 0) return;
  unexplained_.alike = 0;
  for (const ToolContact& contact : hold.contacts)
    unexplained_.alike += (hold.pose.q_WT * contact.n_T).dot(unexplained_.n_W) >= kSameDirection ? 1 : 0;
}

// --- a new frame ---

void SheetPatches::follow(Patch& patch, const std::shared_ptr<const NeighbourSearch>& frame,
                          const ToolHold& hold, double captured_s) {
  const double interval_s = captured_s - patch.captured_s;
  const SheetUpdate update =
      patch.tracker->on_frame(frame, proxy_position(patch, hold.pose, hold.held), interval_s);
  patch.missing = update.points == nullptr;
  if (patch.missing) return;
  patch.interval_s = interval_s, patch.captured_s = captured_s;
  if (patch.of_group || holds(patch, hold.held)) return;
  const Lowest low = patch.tracker->tracks() ? lowest(patch, hold.pose) : Lowest{};
  patch.in_use = low.found && low.clearance <= kLeft &&
                 patch.tracker->region().frame.normal_W().dot(patch.normal_W) >= kSameSheet;
}

// Returns true if a sheet that begins at a contact is really a surface there and faces the tool. Points
// beside an edge or a corner of the tool also push the tool sideways, but are no such surface.
bool SheetPatches::is_face(const SheetTracker& tracker, double sigma) const {
  constexpr double kAround = 3, kEnough = 0.4, kSteepest = 0.35;
  const HeightMap& map = tracker.map();
  double nodes = 0, covered = 0;
  for (int j = 0; j < HeightMap::kNodes; ++j)
    for (int i = 0; i < HeightMap::kNodes; ++i) {
      if (std::hypot(HeightMap::node_at(i), HeightMap::node_at(j)) > kAround) continue;
      nodes += 1, covered += map.node(i, j).covered ? 1 : 0;
    }
  const HeightMap::Slopes slopes = map.mean_slopes(0, 0, kAround);
  return covered >= kEnough * nodes && std::hypot(slopes.u, slopes.v) <= kSteepest &&
         tracker.sigma() <= 1.4 * sigma + 0.05;
}

// Starts a patch at the unexplained contact, unless a tracked sheet is there.
void SheetPatches::start_patch(const std::shared_ptr<const NeighbourSearch>& frame, double captured_s) {
  const auto unused = std::ranges::find_if(patches_, [](const Patch& p) { return !p.in_use; });
  if (unused == patches_.end()) return;
  SheetTracker& tracker = *unused->tracker;
  const double sigma = patches_.front().tracker->tracks() ? patches_.front().tracker->sigma() : 0;
  tracker.keep(frame);
  tracker.begin(unexplained_.p_W, unexplained_.n_W, sigma);
  unused->missing = false, unused->contacts = 0, unused->captured_s = captured_s;
  unused->normal_W = unexplained_.n_W;
  const bool is_known = std::ranges::any_of(patches_, [&](const Patch& other) {
    return other.in_use && other.tracker->tracks() &&
           other.tracker->region().frame.normal_W().dot(unexplained_.n_W) >= kSameSheet &&
           std::abs(other.tracker->clearance(unexplained_.p_W)) <= 1 + 3.5 * sigma;
  });
  unused->in_use = !is_known && is_face(tracker, sigma);
}

// Computes the motion of the tool with the surfaces that hold it. Their velocity is kept, apart from changes
// that noise does not explain.
ToolSurfaceMotion SheetPatches::carried(const ToolHold& hold) {
  CarriedMotion positions(kLever * unit_m_);
  double interval_s = 0;
  for (std::size_t k = 0; k < hold.contacts.size(); ++k) {
    if (patch_of_[k] < 0) continue;
    const Patch& patch = patches_[static_cast<std::size_t>(patch_of_[k])];
    if (!patch.in_use || patch.missing || !patch.tracker->tracks()) continue;
    const Vec3 p_W = world(hold.pose, hold.contacts[k].r_T);
    const double moved = patch.tracker->moved(p_W), error = patch.tracker->moved_error(p_W);
    if (!std::isfinite(moved + error)) continue;
    positions.add({p_W, patch.tracker->region().frame.normal_W(), moved * unit_m_, error * unit_m_,
                   1.0 / patch.contacts});
    interval_s = std::max(interval_s, patch.interval_s);
  }
  const CarriedMotion::Result result = positions.about(hold.pose.p_W, interval_s * rate_per_s_);
  rate_per_s_ = interval_s > 0 ? Vector6(result.shrunk / interval_s) : Vector6(Vector6::Zero());
  return {result.motion, rate_per_s_};
}

// Returns the displacement that moves the tool out of a sheet that does not hold it but swept over it. It is
// along the sheet's normal, and no longer than the motion of the sheet.
Vec3 SheetPatches::out_of_swept(const Patch& patch, const ToolPose& now, const ToolPose& before) const {
  const SheetTracker& tracker = *patch.tracker;
  double out = 0;
  for (const Vec3& p_T : patch.positions_T) {
    const Vec3 p_W = world(now, p_T), before_W = world(before, p_T);
    const PatchPlace p = tracker.region().frame.place(p_W);
    const double clearance_now = tracker.clearance(p_W),
                 clearance_before = tracker.clearance(before_W) + tracker.moved(before_W);
    if (!(clearance_now < 0) || !(clearance_before > kBehind) || !tracker.map().covers(p.u, p.v))
      continue;  // also skips NaN
    out = std::max(out, std::min(-clearance_now, clearance_before - clearance_now));
  }
  return out * unit_m_ * tracker.region().frame.normal_W();
}

SheetPatches::Update SheetPatches::on_frame(const std::shared_ptr<const NeighbourSearch>& frame,
                                            const ToolHold& hold, double captured_s) {
  if (patch_of_.size() < hold.contacts.size()) patch_of_.resize(hold.contacts.size());
  count_contacts(hold);
  count_unexplained(hold);
  bool seen = false, missing = false;
  for (Patch& patch : patches_) {
    if (!patch.in_use) continue;
    follow(patch, frame, hold, captured_s);
    (patch.missing ? missing : seen) |= holds(patch, hold.held);
  }
  Update update;
  update.missing = missing && !seen;
  if (update.missing) return update;
  if (hold.held)
    update.motion = carried(hold);
  else
    rate_per_s_.setZero();
  ToolPose pose =
      update.motion.displacement.isZero(0) ? hold.pose : moved(hold.pose, update.motion.displacement);
  for (const Patch& patch : patches_) {
    if (!patch.in_use || !patch.tracker->tracks() || holds(patch, hold.held)) continue;
    const Vec3 out_m = out_of_swept(patch, pose, hold.pose);
    pose.p_W += out_m, update.motion.displacement.head<3>() += out_m;
  }
  for (Patch& patch : patches_) note_query(patch, pose);
  if (unexplained_.alike >= kEnoughAlike) start_patch(frame, captured_s);
  return update;
}

// --- between frames ---

void SheetPatches::note_query(Patch& patch, const ToolPose& pose) const {
  patch.queried_W = world(pose, patch.middle_T);
}

bool SheetPatches::must_requery(const ToolPose& pose) const {
  return std::ranges::any_of(patches_, [&](const Patch& patch) {
    if (!patch.in_use || patch.missing) return false;
    const double reach_m = patch.tracker->tracks() ? patch.reach_m : unit_m_;
    return !((world(pose, patch.middle_T) - patch.queried_W).squaredNorm() <= reach_m * reach_m);
  });
}

Vector6 SheetPatches::requery(const ToolPose& pose, bool held) {
  Vector6 out = Vector6::Zero();
  for (Patch& patch : patches_) {
    if (!patch.in_use) continue;
    SheetTracker& tracker = *patch.tracker;
    const bool tracked = tracker.tracks() && !patch.missing;
    const Lowest before = tracked ? lowest(patch, pose) : Lowest{};
    const ProxyPosition position = proxy_position(patch, pose, held);
    if (patch.missing)
      tracker.reacquire(position.p_W);
    else
      tracker.requery(position);
    patch.missing = false;
    note_query(patch, pose);
    if (!before.found || !tracker.changes_points() || before.clearance < kBehind) continue;
    // Denoised points have other positions when the patch has moved, so the tool may now be inside the sheet.
    const Lowest after = lowest(patch, pose);
    const double in = std::min(-after.clearance, before.clearance - after.clearance);
    if (after.found && in > 0) out.head<3>() += in * unit_m_ * tracker.region().frame.normal_W();
  }
  return out;
}

// --- what is shown ---

bool SheetPatches::changes_points() const {
  return std::ranges::any_of(
      patches_, [](const Patch& patch) { return patch.in_use && patch.tracker->changes_points(); });
}

bool SheetPatches::concerns(const BoundingSphere& sphere) const {
  return std::ranges::any_of(patches_, [&](const Patch& patch) {
    if (!patch.in_use || !patch.tracker->changes_points()) return false;
    const Ball ball = patch.tracker->region().around();
    const double reach = ball.radius + sphere.radius_m;
    return (ball.centre - sphere.centre_W).squaredNorm() <= reach * reach;
  });
}

// Moves a point onto the nearest sheet and sets its normal. If patches of that sheet overlap, the result is
// their weighted mean. A point of another surface, or outside all patches, stays as it is. Returns false for
// a stray point, which is not shown.
bool SheetPatches::apply(Point& point) const {
  const Vec3 measured_W = point.p_W;
  const auto each = [&](auto&& use) {
    for (const Patch& patch : patches_)
      if (patch.in_use && patch.tracker->changes_points())
        use(*patch.tracker, patch.tracker->shown(measured_W));
  };
  bool inside = false, is_surface = false;
  double nearest = std::numeric_limits<double>::infinity();
  Vec3 normal_W = Vec3::Zero();
  each([&](const SheetTracker&, const ShownPoint& shown) {
    inside |= shown.kind != ShownPoint::Kind::outside;
    is_surface |= shown.kind == ShownPoint::Kind::surface;
    if (shown.kind != ShownPoint::Kind::sheet || !(std::abs(shown.residual) < nearest)) return;
    nearest = std::abs(shown.residual), normal_W = shown.normal_W;
  });
  if (std::isinf(nearest)) return !inside || is_surface;
  double weight = 0;
  Point sum{Vec3::Zero(), Vec3::Zero(), 0};
  each([&](const SheetTracker& tracker, const ShownPoint& shown) {
    if (shown.kind != ShownPoint::Kind::sheet || shown.normal_W.dot(normal_W) < kSameSheet) return;
    const double w = shown.weight + 1e-9;
    // Noise along the sheet makes the spacing of the points irregular, so their disks must be wider to leave
    // no holes.
    const double spacing = 1 / std::sqrt(std::max(tracker.density(), 1.0));
    const double disorder = 1 + std::min(1.0, 2 * tracker.sigma() / spacing);
    sum.p_W += w * shown.p_W, sum.n_W += w * shown.normal_W;
    sum.spacing_m += w * spacing * disorder * unit_m_;
    weight += w;
  });
  point = {sum.p_W / weight, sum.n_W.normalized(), sum.spacing_m / weight};
  return true;
}

}  // namespace remote_touch
