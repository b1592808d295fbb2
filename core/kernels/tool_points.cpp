// Surface disks near a tool, 6.2.2: their positions, the trilinear distance field there, and a lower bound of
// the distance of any position on a disk. The operations are those of voxel_tool.cpp and near_points.cpp, in
// the same order.

#include <immintrin.h>

#include "core/kernels/field_lanes.h"
#include "core/kernels/level.h"
#include "core/kernels/tool_kernels.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

// Returns 1 if x is positive, else 0. It is computed from the sign of -x.
inline Flags is_positive(Doubles x) {
  return (Flags)(0 - x) < 0 ? Flags{} + 1 : Flags{};
}

// Appends the lanes of `may` that are within the limits to the columns, from index `to` on. Returns their
// number.
inline std::size_t put_disks(const PositionsInField& positions, const DisksInField& disks, Flags may,
                             const DiskLimits& limits, double cells_per_m, const DiskColumns& out,
                             std::size_t to) {
  const Packing packing(may & ((disks.lower <= limits.lower) | ~positions.at.is_known));
  const std::size_t count = packing.count();
  if (count == 0) return 0;
  const Doubles3 &p = positions.p_T, &n = disks.n_T, &g = positions.at.gradient_T;
  const auto put_three = [&](const Doubles3& a, double* const(&columns)[3]) {
    packing.put(a.x, columns[0] + to), packing.put(a.y, columns[1] + to), packing.put(a.z, columns[2] + to);
  };
  put_three(p, out.p_T), put_three(n, out.n_T), put_three(g, out.gradient_T);
  const Doubles distance = positions.at.distance, lower = disks.lower;
  packing.put(disks.radius, out.radius + to);
  packing.put(disks.extent, out.extent + to);
  packing.put(distance, out.distance + to);
  packing.put(disks.slope, out.slope + to);
  packing.put(positions.at.is_known ? lower : broadcast(__builtin_nan("")), out.lower + to);
  const Flags is_exact = (lower <= limits.search) & is_flat(disks.slope, disks.radius, disks.extent);
  packing.put(is_exact ? distance : lower, out.bound + to);
  const Flags octant = is_positive(g.x) << 2 | is_positive(g.y) << 1 | is_positive(g.z);
  packing.put((Doubles)(cell_number(p, cells_per_m) << 3 | octant), out.cell + to);
  return count;
}

}  // namespace

std::size_t disks_in_field(const PointColumns& points, std::size_t count, DiskShape shape,
                           const PosedField& f, const DiskLimits& limits, GroupDistances groups,
                           const DiskColumns& out, std::size_t& outside_count) {
  std::size_t found = 0;
  outside_count = 0;
  for (std::size_t i = 0; i < count; i += kLanes) {
    double& of_group = groups.nearest[i / kLanes];
    if (!groups.is_new && of_group > limits.passed) continue;
    Doubles min = broadcast(1e300);
    for (std::size_t part = i; part < i + kLanes && part < count; part += kDoubles) {
      const PositionsInField positions = positions_at(points, part, f);
      const Flags is_point = lane_numbers() < static_cast<long>(count - part);
      const Flags outside = is_point & ~positions.at.is_known;
      min = positions.at.distance < min ? positions.at.distance : min;
      const Flags may = (is_point & (positions.at.distance <= limits.reach)) | outside;
      if (!is_any(may)) continue;
      found += put_disks(positions, disks_at(points, part, shape.fraction, f, positions.at), may, limits,
                         shape.cells_per_m, out, found);
      outside_count += Packing(outside).count();
    }
    if (groups.is_new) of_group = least(min);
  }
  return found;
}

// Detection of points in the relevant cells of a tool, 6.2.2. Each point is transformed to the frame of the
// cells, and the value of its cell is read. The operations of the transform have the same order on every
// level, so the cell of a point is the same too.

#if defined(__AVX512F__)

namespace {

// Returns a coordinate of eight points in cells, rounded towards zero. NaN and values beyond the range of
// integers become negative.
inline __m256i coordinate(const double row[4], __m512d x, __m512d y, __m512d z) {
  const __m512d along = _mm512_add_pd(
      _mm512_add_pd(_mm512_mul_pd(_mm512_set1_pd(row[0]), x), _mm512_mul_pd(_mm512_set1_pd(row[1]), y)),
      _mm512_mul_pd(_mm512_set1_pd(row[2]), z));
  return _mm512_cvttpd_epi32(_mm512_add_pd(along, _mm512_set1_pd(row[3])));
}

}  // namespace

std::size_t points_in_cells(const double* x, const double* y, const double* z, const std::uint32_t* groups,
                            std::size_t group_count, const CellTransform& to_cells, const CellTable& table,
                            int min, std::uint32_t* found) {
  const __m256i columns = _mm256_set1_epi32(table.cells[0]), rows = _mm256_set1_epi32(table.cells[1]),
                layers = _mm256_set1_epi32(table.cells[2]), limit = _mm256_set1_epi32(min);
  const __m256i lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  std::size_t n = 0;
  for (std::size_t g = 0; g < group_count; ++g) {
    const std::size_t at = kLanes * std::size_t{groups[g]};
    const __m512d px = _mm512_loadu_pd(x + at), py = _mm512_loadu_pd(y + at), pz = _mm512_loadu_pd(z + at);
    const __m256i i = coordinate(to_cells.row[0], px, py, pz), j = coordinate(to_cells.row[1], px, py, pz),
                  k = coordinate(to_cells.row[2], px, py, pz);
    __mmask8 in = _mm256_cmplt_epu32_mask(i, columns);
    in = _mm256_mask_cmplt_epu32_mask(in, j, rows);
    in = _mm256_mask_cmplt_epu32_mask(in, k, layers);
    if (in == 0) continue;
    const __m256i cell =
        _mm256_add_epi32(_mm256_mullo_epi32(_mm256_add_epi32(_mm256_mullo_epi32(k, rows), j), columns), i);
    const __m256i words = _mm256_mmask_i32gather_epi32(_mm256_setzero_si256(), in, cell,
                                                       reinterpret_cast<const int*>(table.value), 1);
    const __m256i values = _mm256_srai_epi32(_mm256_slli_epi32(words, 24), 24);
    in = _mm256_mask_cmpge_epi32_mask(in, values, limit);
    const __m256i number = _mm256_add_epi32(lanes, _mm256_set1_epi32(static_cast<int>(at)));
    // The compressing store instruction is avoided, because it needs a hundred cycles on some processors;
    // found has room for whole groups.
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(found + n), _mm256_maskz_compress_epi32(in, number));
    n += static_cast<std::size_t>(__builtin_popcount(in));
  }
  return n;
}

#else

namespace {

#if defined(__AVX2__)
constexpr std::size_t kWidth = 4;
inline void store_coordinate(const double row[4], const double* x, const double* y, const double* z,
                             std::int32_t* out) {
  const __m256d along =
      _mm256_add_pd(_mm256_add_pd(_mm256_mul_pd(_mm256_set1_pd(row[0]), _mm256_loadu_pd(x)),
                                  _mm256_mul_pd(_mm256_set1_pd(row[1]), _mm256_loadu_pd(y))),
                    _mm256_mul_pd(_mm256_set1_pd(row[2]), _mm256_loadu_pd(z)));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(out),
                   _mm256_cvttpd_epi32(_mm256_add_pd(along, _mm256_set1_pd(row[3]))));
}
#else
constexpr std::size_t kWidth = 2;
inline void store_coordinate(const double row[4], const double* x, const double* y, const double* z,
                             std::int32_t* out) {
  const __m128d along = _mm_add_pd(_mm_add_pd(_mm_mul_pd(_mm_set1_pd(row[0]), _mm_loadu_pd(x)),
                                              _mm_mul_pd(_mm_set1_pd(row[1]), _mm_loadu_pd(y))),
                                   _mm_mul_pd(_mm_set1_pd(row[2]), _mm_loadu_pd(z)));
  _mm_storel_epi64(reinterpret_cast<__m128i*>(out), _mm_cvttpd_epi32(_mm_add_pd(along, _mm_set1_pd(row[3]))));
}
#endif

}  // namespace

// Computes the coordinates of eight points in vectors, then reads the cells one by one, because few points
// are inside the grid.
std::size_t points_in_cells(const double* x, const double* y, const double* z, const std::uint32_t* groups,
                            std::size_t group_count, const CellTransform& to_cells, const CellTable& table,
                            int min, std::uint32_t* found) {
  const auto columns = static_cast<std::uint32_t>(table.cells[0]),
             rows = static_cast<std::uint32_t>(table.cells[1]),
             layers = static_cast<std::uint32_t>(table.cells[2]);
  std::size_t n = 0;
  for (std::size_t g = 0; g < group_count; ++g) {
    const std::size_t at = kLanes * std::size_t{groups[g]};
    std::int32_t cell[3][kLanes];
    for (int axis = 0; axis < 3; ++axis)
      for (std::size_t lane = 0; lane < kLanes; lane += kWidth)
        store_coordinate(to_cells.row[axis], x + at + lane, y + at + lane, z + at + lane, cell[axis] + lane);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const auto i = static_cast<std::uint32_t>(cell[0][lane]), j = static_cast<std::uint32_t>(cell[1][lane]),
                 k = static_cast<std::uint32_t>(cell[2][lane]);
      if (!((i < columns) & (j < rows) & (k < layers))) continue;
      found[n] = static_cast<std::uint32_t>(at + lane);
      n += table.value[(k * rows + j) * columns + i] >= min ? 1 : 0;
    }
  }
  return n;
}

#endif

// Detection of the points near a tool, 6.2.2, and the trilinear distance field at them. The operations are
// those of voxel_tool.cpp, in the same order.

std::size_t points_in_field(const PointColumns& points, const std::uint32_t* groups, std::size_t group_count,
                            const PosedField& f, const PointLimits& limits, GroupDistances distances,
                            const PositionColumns& out, std::size_t& outside_count) {
  std::size_t found = 0;
  outside_count = 0;
  for (std::size_t g = 0; g < group_count; ++g) {
    if (distances.nearest[g] > limits.passed) continue;
    Doubles min = broadcast(1e300);
    const std::size_t first = kLanes * std::size_t{groups[g]};
    for (std::size_t i = first; i < first + kLanes; i += kDoubles) {
      const PositionsInField positions = positions_at(points, i, f);
      const Doubles distance = positions.at.distance;
      min = distance < min ? distance : min;
      const Flags reached = distance <= limits.reach;
      if (!is_any(reached)) continue;
      const Packing packing(reached);
      packing.put(positions.p_T.x, out.p_T[0] + found), packing.put(positions.p_T.y, out.p_T[1] + found);
      packing.put(positions.p_T.z, out.p_T[2] + found);
      packing.put(positions.at.is_known ? distance : broadcast(__builtin_nan("")), out.distance + found);
      Doubles number;
      for (std::size_t lane = 0; lane < kDoubles; ++lane) number[lane] = static_cast<double>(i + lane);
      packing.put(number, out.number + found);
      found += packing.count();
      outside_count += Packing(reached & ~positions.at.is_known).count();
    }
    if (distances.is_new) distances.nearest[g] = least(min);
  }
  return found;
}

// The points of a cloud that a tool touches, 6.2.2: points that lie in voxels, and points outside the voxels
// whose distance is small enough. Every touched point is counted. The operations are those of voxel_tool.cpp
// and near_points.cpp, in the same order.

namespace {

constexpr long kInterior = 2;  // the value of Voxel::interior

// Reads the voxels of cells, one by one.
inline Flags voxels_at(const CellTable& table, Counts cell) {
  Flags voxels;
  for (int lane = 0; lane < kDoubles; ++lane)
    voxels[lane] = static_cast<std::uint8_t>(table.value[cell[lane]]);  // 0 to 2
  return voxels;
}

// Returns the lanes whose disks may be as near as `touch`. The slope of the field in the plane of a normal n
// is at most the length of its gradient times the larger of 1 and |1 - n.n|.
inline Flags can_touch(const PointColumns& points, std::size_t i, double fraction, const TouchLimits& limits,
                       Doubles distance) {
  constexpr double kRounding = 1 + 1e-9;
  const Doubles3 n{load(points.nx + i), load(points.ny + i), load(points.nz + i)};
  const Doubles off = magnitude(1 - dot(n, n)), steep = off < 1 ? broadcast(1) : off;
  const Doubles radius = fraction * load(points.spacing + i) + load(points.extent + i);
  return ~(distance > limits.touch + kRounding * limits.slope * (steep * radius));  // true without a normal
}

class Summary {
 public:
  explicit Summary(TouchedSummary& out) : out_(out) {}

  // Counts the touched lanes and stores the numbers of their clusters.
  void add(Flags touched, Flags cluster) {
    const Packing all(touched);
    if (all.count() == 0) return;
    out_.point_count += all.count();
    const Packing others(touched & (cluster != last_cluster_));  // neighbours mostly follow each other
    if (others.count() == 0) return;
    others.put((Doubles)cluster, reinterpret_cast<double*>(out_.cluster + out_.clusters));
    out_.clusters += others.count();
    last_cluster_ = static_cast<long>(out_.cluster[out_.clusters - 1]);
  }
  void add_unclear(Flags unclear, std::size_t first) {
    if (!is_any(unclear)) return;
    for (std::size_t lane = 0; lane < kDoubles; ++lane)
      if (unclear[lane]) out_.unclear[out_.unclear_count++] = static_cast<std::uint32_t>(first + lane);
  }

 private:
  TouchedSummary& out_;
  long last_cluster_ = -1;
};

}  // namespace

void touched_points(const PointColumns& points, const std::uint32_t* groups, std::size_t group_count,
                    DiskShape shape, const PosedField& f, const CellTable& voxels, const TouchLimits& limits,
                    GroupDistances distances, TouchedSummary& out) {
  constexpr double kInfinite = __builtin_inf();
  out.point_count = out.clusters = out.unclear_count = 0;
  Summary summary(out);
  Doubles least_of_all = broadcast(kInfinite);
  Flags inside{};
  for (std::size_t g = 0; g < group_count; ++g) {
    if (distances.nearest[g] > limits.passed) continue;
    Doubles least_of_group = broadcast(kInfinite);
    for (std::size_t i = kLanes * std::size_t{groups[g]}; i < kLanes * (std::size_t{groups[g]} + 1);
         i += kDoubles) {
      const PositionsInField positions = positions_at(points, i, f);
      const Doubles distance = positions.at.distance;
      least_of_group = distance < least_of_group ? distance : least_of_group;
      const Flags reached = distance <= limits.reach;
      if (!is_any(reached)) continue;
      const Flags known = reached & positions.at.is_known;
      const Doubles counted = known ? distance : broadcast(kInfinite);
      least_of_all = counted < least_of_all ? counted : least_of_all;
      const Flags voxel = (known & positions.at.in_cell & (distance <= limits.voxels))
                              ? voxels_at(voxels, positions.at.cell)
                              : Flags{};
      inside |= voxel == kInterior;
      Flags touched = voxel != 0, unclear = reached & ~known;
      const Flags may = known & ~touched & can_touch(points, i, shape.fraction, limits, distance);
      if (is_any(may)) {
        const DisksInField disks = disks_at(points, i, shape.fraction, f, positions.at);
        const Flags near = may & (disks.lower <= limits.touch);
        touched |= near & (distance <= limits.touch);
        unclear |= near & ~(distance <= limits.touch) & ~is_flat(disks.slope, disks.radius, disks.extent);
      }
      summary.add(touched, cell_number(positions.p_T, shape.cells_per_m));
      summary.add_unclear(unclear, i);
    }
    if (distances.is_new) distances.nearest[g] = least(least_of_group);
  }
  out.nearest = least(least_of_all);
  out.is_inside = is_any(inside);
}

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
