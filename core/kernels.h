// The inner loops over gathered points, compiled once for each x86-64 level and chosen at run time.
//
// The same bits on every level, for every order of the points: every term is computed by itself in IEEE
// double without contraction, minima and maxima do not depend on order, and sums are exact. A sum is exact
// because each term is first rounded to a fixed grid: with M = 1.5 * 2^m, (t + M) - M rounds t to a multiple
// of 2^(m-52), and up to 2^m terms of magnitude at most 1 then add without rounding (pre-rounding, Demmel and
// Nguyen 2013). The price is an absolute error of 2^(m-53) a term, 1.5e-14 for 256 points.
#pragma once

#include <cstddef>
#include <cstdint>

namespace remote_touch {

// A view of gathered points, padded with far-away points to a multiple of kLanes. radius is r_f of each point
// and stiffness k_s (NaN: the renderer's own); both are null where the cloud has no such column.
struct PointsView {
  const double* x;
  const double* y;
  const double* z;
  const double* radius;
  const double* stiffness;
  std::size_t padded_count;
};

inline constexpr std::size_t kLanes = 8;
inline constexpr double kFarAway = 1e100;  // coordinate of a padding point; its square is still finite

// The radii that define the proxy's regions, Fig 4.2, and what the sums over the points need.
struct ProxyRegions {
  double r1, r2, r3;
  double sum_grid;   // M above, at least 1.5 * the number of points, a power of two times 1.5
  double stiffness;  // of points without one of their own
};

// What one pass over the points tells about a proxy position. r_n = |P - x| - r_f, (5.5).
struct Survey {
  double nearest;        // smallest r_n; infinite without points
  double normal_sum[3];  // (4.1): sum of (P - x)/|P - x| psi(r_n), not normalised
  double weight_sum;     // sum of psi(r_n), points with a stiffness only
  double stiffness_sum;  // (5.8): sum of k_s psi(r_n)
  double touching;       // number of points with r_n <= r2
};

// Stored points with consecutive positions in the columns, as a neighbour search hands them over: count of
// them, or, in an image, rows of count, whose first points are stride apart.
struct PointRun {
  const double* x;
  const double* y;
  const double* z;
  const double* radius;        // may be null
  const double* stiffness;     // may be null
  const std::uint32_t* index;  // null: first_index, first_index + 1, ...
  std::uint32_t first_index;
  std::size_t count;
  std::size_t rows = 1;
  std::size_t stride = 0;
};

// Columns to append to; each has room for every point of the cloud plus kLanes.
struct PointSink {
  double* x;
  double* y;
  double* z;
  double* radius;
  double* stiffness;
  std::uint32_t* index;
};

// Counter and key of the noise generator; see noise.h.
struct NoiseStream {
  std::uint32_t key[2];
  std::uint32_t counter[3];  // the generator's counter without its first word, which is the point's index
};

struct Kernels {
  const char* isa;
  // Appends the points of the run with |x - centre|^2 <= (reach + r_f)^2, all in double; NaN never qualifies.
  // Returns the new count.
  std::size_t (*append_within)(const PointRun&, const double centre[3], double reach, const PointSink&,
                               std::size_t count);
  Survey (*survey)(const PointsView&, const double p[3], const ProxyRegions&);
  // (4.9), (5.9): the smallest d > 0 at which a proxy that moves from p along the unit vector meets a point
  // ahead, |p + d direction - x| = reach + r_f; infinite when it meets none.
  double (*first_hit)(const PointsView&, const double p[3], const double direction[3], double reach);
  // (4.10), (5.11): the largest positive root over the points with r_n < inner; 0 without such points.
  double (*way_out)(const PointsView&, const double p[3], const double direction[3], double reach,
                    double inner);
  // Three standard normals for each of the points index[0..count).
  void (*normals)(const NoiseStream&, const std::uint32_t* index, std::size_t count, double* x, double* y,
                  double* z);
  // Of the points first .. first + count - 1, in order, those whose random words allow the x normal to be
  // what x[i] asks and the z normal what z asks (asks_of in noise.h); of points that are not returned neither
  // is. Returns how many; index has room for count + kLanes.
  std::size_t (*candidates)(const NoiseStream&, std::uint32_t first, std::size_t count,
                            const std::uint64_t* x, std::uint64_t z, std::uint32_t* index);
};

// x86-64 levels in rising order.
enum class Isa { x86_64, x86_64_v3, x86_64_v4 };

Isa best_isa();                   // of the running machine
const Kernels& kernels_for(Isa);  // pre: the machine has that level

}  // namespace remote_touch
