#include "core/dissertation/tool_motion/contact_thinning.h"

#include <algorithm>
#include <bit>
#include <bitset>
#include <cmath>
#include <optional>
#include <utility>

#include "core/kernels/tool_kernels.h"
#include "core/points/number_columns.h"

namespace remote_touch {
namespace {

constexpr int kMaxTries = 64;

}  // namespace

std::uint64_t cell_number(const Vec3& p_T, double cells_per_m) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double whole = p_T[axis] * cells_per_m - kAlmostHalf + kRoundsToWhole;  // no call of the C library
    key = key << 20 | (std::bit_cast<std::uint64_t>(whole) & 0xfffff);
  }
  return key;
}

std::uint64_t cell_and_octant(const Vec3& p_T, const Vec3& direction_T, double cells_per_m) {
  std::uint64_t key = cell_number(p_T, cells_per_m);
  for (int axis = 0; axis < 3; ++axis) key = key << 1 | (direction_T[axis] < 0 ? 1u : 0u);
  return key;
}

// Returns the slot that has held a key since begin(), or else an unused one; null if kMaxTries slots hold
// other keys.
ContactThinning::Slot* ContactThinning::slot_of(std::uint64_t key) {
  std::size_t at = first_slot(key);
  for (int tries = 0; tries < kMaxTries; ++tries, at = (at + 1) % kSlots)
    if (slots_[at].stamp != stamp_ || slots_[at].key == key) return &slots_[at];
  return nullptr;
}

void ContactThinning::begin() {
  if (++stamp_ == 0) {  // an old stamp must not count as current after 2^32 calls
    std::fill(slots_.begin(), slots_.end(), Slot{});
    stamp_ = 1;
  }
  cells_ = 0;
}

std::size_t ContactThinning::find_cell(std::uint64_t key) {
  Slot* slot = slot_of(key);
  if (!slot) return kNoCell;
  if (slot->stamp != stamp_) *slot = {key, cells_++, stamp_};
  return slot->cell;
}

void ContactThinning::thin(std::vector<ToolContact>& contacts, std::size_t max) {
  constexpr double kGrowth = 1.5;
  for (double cell_m = kCell_m; contacts.size() > max; cell_m *= kGrowth) thin_in_cells(contacts, cell_m);
}

void ContactThinning::thin_in_cells(std::vector<ToolContact>& contacts, double cell_m) {
  begin();
  std::size_t kept = 0, read = 0;
  for (; read < contacts.size(); ++read) {  // only contacts already read are overwritten
    const ToolContact& contact = contacts[read];
    const std::size_t place = cell(cell_and_octant(contact.r_T, contact.n_T, 1 / cell_m));
    if (place == kNoCell) break;
    if (place == kept)
      contacts[kept++] = contact;
    else if (contact.depth_m > contacts[place].depth_m)
      contacts[place] = contact;
  }
  const auto first_unread = contacts.begin() + static_cast<std::ptrdiff_t>(read);
  contacts.erase(contacts.begin() + static_cast<std::ptrdiff_t>(kept), first_unread);
}

namespace {

constexpr std::size_t kWorth = 2;      // factor by which the number of points must fall
constexpr double kSquare = 1.5;        // spacings: at any angle, every such square of a full grid has a point
constexpr int kMaxSquares = 32;        // number of squares along a side
constexpr double kMinAgreement = 0.5;  // minimum length of the mean of the normals

// The points of a cloud, sorted by the cubes of a grid.
class Cubes {
 public:
  Cubes(std::span<const CloudPoint> points, double cube_m) : cube_m_(cube_m) {
    numbers_.reserve(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i)
      numbers_.emplace_back(cell_number(points[i].p_W, 1 / cube_m), i);
    std::sort(numbers_.begin(), numbers_.end());
    for (const auto& number : numbers_) sorted_.push_back(points[number.second]);
  }

  // Returns the points of the cube whose first point has the index `first`.
  std::span<const CloudPoint> from(std::size_t first) const {
    std::size_t end = first;
    while (end < numbers_.size() && numbers_[end].first == numbers_[first].first) ++end;
    return std::span(sorted_).subspan(first, end - first);
  }
  std::size_t size() const { return sorted_.size(); }

  // Visits every point of the cube that contains p_W and of the 26 cubes around it.
  template <class Visit>  // (point)
  void for_each_around(const Vec3& p_W, const Visit& visit) const {
    for (int i = 0; i < 27; ++i) {
      const int x = i % 3 - 1, y = i / 3 % 3 - 1, z = i / 9 - 1;
      const Vec3 there_W = p_W + cube_m_ * Vec3(x, y, z);
      const std::pair<std::uint64_t, std::uint32_t> begin{cell_number(there_W, 1 / cube_m_), 0};
      const auto at = std::lower_bound(numbers_.begin(), numbers_.end(), begin);
      if (at == numbers_.end() || at->first != begin.first) continue;
      for (const CloudPoint& point : from(static_cast<std::size_t>(at - numbers_.begin()))) visit(point);
    }
  }

 private:
  const double cube_m_;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> numbers_;  // numbers of the cube and of the point
  std::vector<CloudPoint> sorted_;
};

// Returns the disk in the middle of the points; nullopt if they are not flat, or if their spacing is not
// known.
std::optional<PointOrDisk> flat_disk(std::span<const CloudPoint> points) {
  const double spacing_m = points[0].spacing_m;
  PointOrDisk disk{Vec3::Zero(), Vec3::Zero(), spacing_m, 0};
  for (const CloudPoint& point : points) disk.p_W += point.p_W, disk.n_W += point.n_W;
  const double length = disk.n_W.norm(), count = static_cast<double>(points.size());
  if (points.size() < 2 || !(spacing_m > 0)) return {};  // 0: not known
  if (!(length > kMinAgreement * count)) return {};      // false for NaN
  disk.p_W /= count, disk.n_W /= length;
  for (const CloudPoint& point : points) {
    const Vec3 offset = point.p_W - disk.p_W;
    if (std::abs(offset.dot(disk.n_W)) + spacing_m * (point.n_W - disk.n_W).norm() > kFlat_m) return {};
    disk.extent_m = std::max(disk.extent_m, offset.norm());
  }
  return disk;
}

bool is_covered(const PointOrDisk& disk, const Cubes& cubes) {
  const double squares = std::floor(2 * disk.extent_m / (kSquare * disk.spacing_m));
  if (squares > kMaxSquares) return false;
  const int side = std::max(static_cast<int>(squares), 1);
  const double square_m = 2 * disk.extent_m / side;
  const Vec3 u = disk.n_W.unitOrthogonal(), v = disk.n_W.cross(u);
  std::bitset<kMaxSquares * kMaxSquares> has_point;  // set() throws outside
  cubes.for_each_around(disk.p_W, [&](const CloudPoint& point) {
    const Vec3 offset = point.p_W - disk.p_W;
    if (!(std::abs(offset.dot(disk.n_W)) <= disk.spacing_m)) return;
    const double x = std::floor((offset.dot(u) + disk.extent_m) / square_m),
                 y = std::floor((offset.dot(v) + disk.extent_m) / square_m);
    if (x >= 0 && x < side && y >= 0 && y < side)
      has_point.set(static_cast<std::size_t>(y) * kMaxSquares + static_cast<std::size_t>(x));
  });
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const int right = 2 * x + 1 - side, up = 2 * y + 1 - side;  // position of the middle, in half squares
      const bool is_in_disk = right * right + up * up <= side * side;
      if (is_in_disk && !has_point[static_cast<std::size_t>(y * kMaxSquares + x)]) return false;
    }
  return true;
}

}  // namespace

std::vector<PointOrDisk> merged_points(std::span<const CloudPoint> points, double cube_m) {
  std::vector<double> spacing_m;
  for (const CloudPoint& point : points) spacing_m.push_back(point.spacing_m);
  if (spacing_m.empty() || !(median_in_place(spacing_m) <= kMaxMergedSpacing_m)) return {};
  const Cubes cubes(points, cube_m);
  std::vector<PointOrDisk> merged;
  for (std::size_t first = 0; first < cubes.size();) {
    const std::span<const CloudPoint> cube = cubes.from(first);
    const std::optional<PointOrDisk> disk = flat_disk(cube);
    if (disk && is_covered(*disk, cubes))
      merged.push_back(*disk);
    else
      for (const CloudPoint& point : cube) merged.push_back({point.p_W, point.n_W, point.spacing_m, 0});
    first += cube.size();
  }
  if (kWorth * merged.size() > points.size()) merged.clear();
  return merged;
}

}  // namespace remote_touch
