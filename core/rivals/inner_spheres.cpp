#include "core/rivals/inner_sphere_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <utility>

#include "core/mesh/triangle_tree.h"
#include "core/parameters/parameter.h"
#include "core/points/vector.h"

namespace remote_touch {
namespace {

constexpr std::size_t kMaxNodes = 500000;  // nodes inside a tool that are tried
// Smallest radius, in voxels. Outside a closed mesh the trilinear field is positive at distances above
// sqrt(3) / 2 voxels. So a centre at which the field is negative is certainly inside if it is this far from
// the mesh.
constexpr double kSmallest = 0.9;
constexpr double kMirrored = 0.1;  // a mesh is symmetric if its mirror image deviates by less, in voxels
// A sphere that overlaps its mirror image is made smaller if this fraction of the radius remains. Otherwise
// it is moved onto the plane.
constexpr double kShrunk = 0.98;
// The steps of a prototype: their number, and the ratio of each to the one before. The first is one spacing
// of nodes; the sum of all is below kTravel spacings.
constexpr int kSteps = 40;
constexpr double kCooling = 0.85, kTravel = 1 / (1 - kCooling);
constexpr double kRounding = 1e-6;  // relative rounding of a radius that is stored as a float

class Packing {
 public:
  explicit Packing(const VoxelTool& tool)
      : tool_(tool), boundary_(tool.mesh), smallest_m_(kSmallest * tool.grid.size_m) {
    for (int axis = 0; axis < 3; ++axis)
      mirrored_[static_cast<std::size_t>(axis)] = equals_mirror_image(axis);
    gather_nodes();
  }

  // The room of a node never grows, so a number in the queue is an upper bound. Only the node on top has to
  // be evaluated again.
  std::vector<Sphere> packed(std::size_t max) {
    while (!candidates_.empty() && spheres_.size() < max) {
      const Candidate best = candidates_.top();
      candidates_.pop();
      max_room_m_ = static_cast<double>(best.room_m);
      float& room_m = room_m_[best.node];
      if (room_m == best.room_m) {
        const Vec3 p = position(best.node);
        gather_near(p, max_room_m_);
        // Deep inside, the field can be too large by a voxel.
        const double exact_m = room_around(p).radius_m;
        if (exact_m < (1 - kRounding) * max_room_m_)
          room_m = static_cast<float>(std::max(0.0, exact_m));
        else if (!add_with_images(fitted(p), max))
          room_m = 0;
      }
      if (static_cast<double>(room_m) >= smallest_m_) candidates_.push({room_m, best.node});
    }
    return std::move(spheres_);
  }

 private:
  using Axes = std::array<bool, 3>;
  struct Candidate {
    float room_m;
    std::uint32_t node;
    bool operator<(const Candidate& other) const {
      return room_m != other.room_m ? room_m < other.room_m : node > other.node;
    }
  };
  // The largest radius of a sphere around a position, and the unit vector from the nearest obstacle to the
  // position; zero if there is none. The radius is negative outside the tool and in a packed sphere.
  struct Room {
    double radius_m;
    Vec3 away;
  };

  // Tests the vertices and the middles of the triangles.
  bool equals_mirror_image(int axis) const {
    const double max_m = kMirrored * tool_.grid.size_m;
    const auto is_on_mesh = [&](Vec3 p) {
      p[axis] = -p[axis];
      return boundary_.nearest(p, 0).squared_m2 <= max_m * max_m;
    };
    const std::vector<Vec3>& vertices = tool_.mesh.vertices;
    const auto corner = [&](int i) -> const Vec3& { return vertices[static_cast<std::size_t>(i)]; };
    return std::all_of(vertices.begin(), vertices.end(), is_on_mesh) &&
           std::all_of(tool_.mesh.triangles.begin(), tool_.mesh.triangles.end(), [&](const auto& t) {
             return is_on_mesh((corner(t[0]) + corner(t[1]) + corner(t[2])) / 3);
           });
  }

  void gather_nodes() {
    const VoxelGrid& grid = tool_.grid;
    const auto inside = static_cast<std::size_t>(std::count_if(
        tool_.distance_m.begin(), tool_.distance_m.end(), [](float distance_m) { return distance_m < 0; }));
    std::size_t stride = 1;
    while (inside > kMaxNodes * stride * stride * stride) ++stride;
    spacing_m_ = static_cast<double>(stride) * grid.size_m;
    for (std::size_t axis = 0; axis < 3; ++axis)
      nodes_[axis] = grid.cells[axis] / static_cast<int>(stride) + 1;
    const std::size_t row = static_cast<std::size_t>(grid.cells[0]) + 1,
                      layer = row * (static_cast<std::size_t>(grid.cells[1]) + 1);
    std::vector<Candidate> candidates;
    for (std::size_t k = 0; k < static_cast<std::size_t>(nodes_[2]); ++k)
      for (std::size_t j = 0; j < static_cast<std::size_t>(nodes_[1]); ++j)
        for (std::size_t i = 0; i < static_cast<std::size_t>(nodes_[0]); ++i) {
          const float room_m = std::max(0.0f, -tool_.distance_m[stride * (i + row * j + layer * k)]);
          if (static_cast<double>(room_m) >= smallest_m_)
            candidates.push_back({room_m, static_cast<std::uint32_t>(room_m_.size())});
          room_m_.push_back(room_m);
        }
    candidates_ = std::priority_queue<Candidate>({}, std::move(candidates));
  }

  Vec3 position(std::uint32_t node) const {
    const auto columns = static_cast<std::uint32_t>(nodes_[0]), rows = static_cast<std::uint32_t>(nodes_[1]);
    const std::uint32_t line = node / columns, layer = line / rows;
    return tool_.grid.origin_T + spacing_m_ * Vec3(node % columns, line % rows, layer);
  }

  // Gathers the packed spheres that are less than reach_m away from p.
  void gather_near(const Vec3& p, double reach_m) {
    near_.clear();
    for (std::uint32_t i = 0; i < spheres_.size(); ++i) {
      const double reach_of_centre_m = spheres_[i].radius_m + reach_m;
      if ((spheres_[i].centre - p).squaredNorm() < reach_of_centre_m * reach_of_centre_m) near_.push_back(i);
    }
  }

  // Returns the direction in which the distance to the mesh grows, by differences over a voxel. On the ridges
  // of the distance the gradient of the field is that of one side only.
  Vec3 away_from_mesh(const Vec3& p) const {
    Vec3 away;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 half = 0.5 * tool_.grid.size_m * Vec3::Unit(axis);
      away[axis] = sample_field(tool_, p - half).distance_m - sample_field(tool_, p + half).distance_m;
    }
    return away;
  }

  Room room_around(const Vec3& p) const {
    const double field_m = sample_field(tool_, p).distance_m;
    const bool is_outside = field_m > 0;
    Room room{is_outside ? -field_m : std::sqrt(boundary_.nearest(p, 0).squared_m2), away_from_mesh(p)};
    for (const std::uint32_t i : near_) {
      const Vec3 offset = p - spheres_[i].centre;
      const double gap_m = offset.norm() - spheres_[i].radius_m;
      if (gap_m < room.radius_m) room = {gap_m, offset};
    }
    const double length = room.away.norm();
    room.away = length > 0 ? Vec3(room.away / length) : Vec3::Zero();
    return room;
  }

  // Returns the largest sphere on the way of a prototype. The coordinates along the axes on_plane stay 0.
  Sphere climbed(const Vec3& start, const Axes& on_plane) {
    gather_near(start, max_room_m_ + 2 * kTravel * spacing_m_);
    Sphere best{start, -1};
    Vec3 p = start;
    double step_m = spacing_m_;
    for (int i = 0; i < kSteps; ++i, step_m *= kCooling) {
      Room room = room_around(p);
      if (room.radius_m > best.radius_m) best = {p, room.radius_m};
      for (int axis = 0; axis < 3; ++axis)
        if (on_plane[static_cast<std::size_t>(axis)]) room.away[axis] = 0;
      p += step_m * room.away;
    }
    return best;
  }

  // Returns a large sphere near a node. Its mirror images overlap it little, or it lies on the mirror plane.
  Sphere fitted(const Vec3& start) {
    Axes on_plane{};
    Sphere best = climbed(start, on_plane);
    for (bool is_moved = true; is_moved;) {
      is_moved = false;
      for (int axis = 0; axis < 3; ++axis) {
        bool& is_on_plane = on_plane[static_cast<std::size_t>(axis)];
        if (is_on_plane || !mirrored_[static_cast<std::size_t>(axis)]) continue;
        if (std::abs(best.centre[axis]) >= kShrunk * best.radius_m) continue;
        best.centre[axis] = 0;
        is_on_plane = is_moved = true;
      }
      if (is_moved) best = climbed(best.centre, on_plane);
    }
    return best;
  }

  // Adds a sphere and its mirror images, all with the radius for which each of them has room. Images beyond
  // `max` spheres are left out. Returns false if that radius is too small.
  bool add_with_images(const Sphere& sphere, std::size_t max) {
    std::vector<Vec3> centres{sphere.centre};
    double radius_m = sphere.radius_m;
    for (int axis = 0; axis < 3; ++axis) {
      if (!mirrored_[static_cast<std::size_t>(axis)] || sphere.centre[axis] == 0) continue;
      radius_m = std::min(radius_m, std::abs(sphere.centre[axis]));
      for (std::size_t i = 0, count = centres.size(); i < count; ++i) {
        centres.push_back(centres[i]);
        centres.back()[axis] = -centres[i][axis];
      }
    }
    for (const Vec3& centre : centres) {
      gather_near(centre, radius_m);
      radius_m = std::min(radius_m, room_around(centre).radius_m);
    }
    if (radius_m < smallest_m_) return false;
    for (const Vec3& centre : centres) {
      if (spheres_.size() == max) break;
      spheres_.push_back({centre, radius_m});
      take_room(spheres_.back());
    }
    return true;
  }

  // Reduces the room of the nodes around a new sphere.
  void take_room(const Sphere& sphere) {
    const double reach_m = sphere.radius_m + max_room_m_;
    std::array<std::int64_t, 3> first{}, last{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      const double at_m = sphere.centre[axis] - tool_.grid.origin_T[axis];
      first[i] =
          std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil((at_m - reach_m) / spacing_m_)));
      last[i] = std::min<std::int64_t>(nodes_[i] - 1,
                                       static_cast<std::int64_t>(std::floor((at_m + reach_m) / spacing_m_)));
    }
    for (std::int64_t k = first[2]; k <= last[2]; ++k)
      for (std::int64_t j = first[1]; j <= last[1]; ++j)
        for (std::int64_t i = first[0]; i <= last[0]; ++i) {
          const auto node = static_cast<std::uint32_t>((k * nodes_[1] + j) * nodes_[0] + i);
          if (!(room_m_[node] > 0)) continue;
          const double gap_m = (position(node) - sphere.centre).norm() - sphere.radius_m;
          room_m_[node] = std::min(room_m_[node], static_cast<float>(std::max(0.0, gap_m)));
        }
  }

  const VoxelTool& tool_;
  const TriangleTree boundary_;
  const double smallest_m_;
  Axes mirrored_{};             // the tool equals its mirror image along these axes
  double spacing_m_ = 0;        // distance between the nodes that are tried
  std::array<int, 3> nodes_{};  // number of nodes along each axis
  std::vector<float> room_m_;   // upper bound of the room around each node; 0 outside the tool
  std::priority_queue<Candidate> candidates_;
  double max_room_m_ = 0;  // no candidate has more
  std::vector<Sphere> spheres_;
  std::vector<std::uint32_t> near_;  // spheres near the prototype
};

struct Neighbours {
  std::uint32_t a, b;
};

// Returns the pairs with a gap of near_m or less, and those of the spanning tree with the smallest sum of
// gaps (Prim's algorithm).
std::vector<Neighbours> neighbours_among(std::span<const Sphere> spheres, double near_m) {
  const auto count = static_cast<std::uint32_t>(spheres.size());
  std::vector<Neighbours> pairs;
  std::vector<double> gap_m(count, std::numeric_limits<double>::infinity());  // gap to the tree
  std::vector<std::uint32_t> from(count, 0);  // sphere of the tree at that gap
  std::vector<std::uint8_t> is_in_tree(count, 0);
  std::uint32_t added = 0;
  for (std::uint32_t size = 1; size < count; ++size) {
    is_in_tree[added] = 1;
    std::uint32_t nearest = count;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (is_in_tree[i]) continue;
      const double to_added_m =
          (spheres[i].centre - spheres[added].centre).norm() - spheres[i].radius_m - spheres[added].radius_m;
      if (to_added_m <= near_m) pairs.push_back({added, i});
      if (to_added_m < gap_m[i]) gap_m[i] = to_added_m, from[i] = added;
      if (nearest == count || gap_m[i] < gap_m[nearest]) nearest = i;
    }
    if (gap_m[nearest] > near_m) pairs.push_back({from[nearest], nearest});
    added = nearest;
  }
  return pairs;
}

void link_neighbours(InnerSpheres& made, double near_m) {
  const std::vector<Neighbours> pairs = neighbours_among(made.spheres, near_m);
  made.first_neighbour.assign(made.spheres.size() + 1, 0);
  for (const Neighbours& pair : pairs) ++made.first_neighbour[pair.a + 1], ++made.first_neighbour[pair.b + 1];
  for (std::size_t i = 0; i < made.spheres.size(); ++i)
    made.first_neighbour[i + 1] += made.first_neighbour[i];
  made.neighbour.resize(2 * pairs.size());
  std::vector<std::uint32_t> next = made.first_neighbour;
  for (const Neighbours& pair : pairs)
    made.neighbour[next[pair.a]++] = pair.b, made.neighbour[next[pair.b]++] = pair.a;
  for (std::size_t i = 0; i < made.spheres.size(); ++i)
    std::sort(made.neighbour.begin() + made.first_neighbour[i],
              made.neighbour.begin() + made.first_neighbour[i + 1]);
}

constexpr double kCellsAlong = 96;
// A sphere is entered in every cell that it reaches if it is larger by this fraction of a cell. So rounding
// at the boundary of a cell cannot lose it.
constexpr double kSlack = 1e-6;

}  // namespace

InnerSpheres make_inner_spheres(const VoxelTool& tool, int max_spheres) {
  InnerSpheres made;
  made.spheres = Packing(tool).packed(static_cast<std::size_t>(max_spheres));
  if (made.spheres.empty())
    throw InputError(
        "tool", "no sphere of the size of a voxel fits into it: expected a smaller renderer.tool_voxel_m");
  double cubes_m3 = 0;
  for (const Sphere& sphere : made.spheres) cubes_m3 += sphere.radius_m * sphere.radius_m * sphere.radius_m;
  made.coverage = 4.0 / 3 * std::numbers::pi * cubes_m3 / tool.volume_m3;
  link_neighbours(made, tool.grid.size_m);
  return made;
}

std::string text(const InnerSpheres& made) {
  const auto tenths = static_cast<long>(std::floor(1000 * made.coverage));  // never more than the true value
  return std::to_string(made.spheres.size()) + " inner spheres fill " + std::to_string(tenths / 10) + "." +
         std::to_string(tenths % 10) + " % of the tool";
}

SphereLocator::SphereLocator(std::span<const Sphere> spheres) : spheres_(spheres) {
  BoundingBox box;
  for (const Sphere& sphere : spheres)
    box.extend(sphere.centre - Vec3::Constant(sphere.radius_m))
        .extend(sphere.centre + Vec3::Constant(sphere.radius_m));
  low_ = box.min(), high_ = box.max();
  cell_m_ = box.sizes().maxCoeff() / kCellsAlong;
  for (int axis = 0; axis < 3; ++axis)
    cells_[static_cast<std::size_t>(axis)] =
        static_cast<std::int64_t>((high_[axis] - low_[axis]) / cell_m_) + 1;
  first_.assign(index(0, 0, cells_[2]) + 1, 0);
  for (const Sphere& sphere : spheres) for_cells_of(sphere, [&](std::size_t cell) { ++first_[cell + 1]; });
  for (std::size_t cell = 0; cell + 1 < first_.size(); ++cell) first_[cell + 1] += first_[cell];
  number_.resize(first_.back());
  std::vector<std::uint32_t> next = first_;
  for (std::uint32_t i = 0; i < spheres.size(); ++i)
    for_cells_of(spheres[i], [&](std::size_t cell) { number_[next[cell]++] = i; });
}

// Returns the cell that contains p, or the nearest cell if p is outside the grid. pre: p is finite.
SphereLocator::Cell SphereLocator::cell_of(const Vec3& p) const {
  Cell cell{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const double last = static_cast<double>(cells_[i] - 1);
    cell[i] = static_cast<std::int64_t>(std::clamp((p[axis] - low_[axis]) / cell_m_, 0.0, last));
  }
  return cell;
}

// Calls act(index) for every cell that the sphere reaches.
template <class Act>
void SphereLocator::for_cells_of(const Sphere& sphere, const Act& act) const {
  const double reach_m = sphere.radius_m + kSlack * cell_m_;
  const Cell first = cell_of(sphere.centre - Vec3::Constant(reach_m)),
             last = cell_of(sphere.centre + Vec3::Constant(reach_m));
  for (std::int64_t k = first[2]; k <= last[2]; ++k)
    for (std::int64_t j = first[1]; j <= last[1]; ++j)
      for (std::int64_t i = first[0]; i <= last[0]; ++i) {
        const Vec3 corner =
            low_ + cell_m_ * Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
        const Vec3 nearest = sphere.centre.cwiseMax(corner).cwiseMin(corner + Vec3::Constant(cell_m_));
        if ((nearest - sphere.centre).squaredNorm() <= reach_m * reach_m) act(index(i, j, k));
      }
}

std::optional<std::uint32_t> SphereLocator::at(const Vec3& p) const {
  // NaN fails the comparison.
  if (!((p.array() >= low_.array()).all() && (p.array() <= high_.array()).all())) return {};
  const Cell cell = cell_of(p);
  const std::size_t here = index(cell[0], cell[1], cell[2]);
  for (std::uint32_t i = first_[here]; i < first_[here + 1]; ++i) {
    const Sphere& sphere = spheres_[number_[i]];
    if ((p - sphere.centre).squaredNorm() < sphere.radius_m * sphere.radius_m) return number_[i];
  }
  return {};
}

}  // namespace remote_touch
