#include "scenarios/synthetic/grid_scene.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace remote_touch {

Parameters parameters(Grid& grid) {
  return {
      {"columns", &grid.columns, 1, 4096, "points along x"},
      {"rows", &grid.rows, 1, 4096, "points along z"},
      {"spacing_m", &grid.spacing_m, 1e-5, 1, "distance between neighbouring points, s_xz of Table 4.2"},
      {"phase_x", &grid.phase_x, -1, 1, "shift of the grid along x, in units of the spacing"},
      {"phase_z", &grid.phase_z, -1, 1, "shift of the grid along z, in units of the spacing"},
  };
}

void add_noise(PointCloud& cloud, double sigma_m, const NoiseStream& stream, const Kernels& kernels) {
  if (sigma_m == 0) return;
  std::vector<std::uint32_t> index(cloud.size());
  std::iota(index.begin(), index.end(), 0u);
  std::vector<double> nx(cloud.size()), ny(cloud.size()), nz(cloud.size());
  kernels.noise.normals(stream, index.data(), index.size(), nx.data(), ny.data(), nz.data());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    cloud.x[i] += sigma_m * nx[i], cloud.y[i] += sigma_m * ny[i], cloud.z[i] += sigma_m * nz[i];
}

namespace {

// Points are made within a margin around a query, so that the next queries of a moving proxy find their
// points ready. A query larger than a proxy's gets no margin: such queries come once a frame.
constexpr double kSpareMargin_m = 0.010, kMaxOfProxy_m = 0.025;
// The same for the near ones of these points, which are copied again more often.
constexpr double kNearMargin_m = 0.004;
// Tolerance that is far above the rounding of sums of metres.
constexpr double kRounding_m = 1e-9;

}  // namespace

NoisyGridSearch::NoisyGridSearch(const Grid& grid, double height_m, double sigma_m, const NoiseStream& stream)
    : grid_(grid), height_m_(height_m), sigma_m_(sigma_m), stream_(stream) {
  // There is capacity for the points and for a copy of the near ones behind them.
  const std::size_t capacity = 2 * (size() + kLanes);
  index_.grow(capacity), x_bounds_.grow(static_cast<std::size_t>(grid.columns) + kLanes);
  z_bounds_.grow(static_cast<std::size_t>(grid.rows));
  x_.grow(capacity), y_.grow(capacity), z_.grow(capacity);
}

double NoisyGridSearch::Cylinder::margin_m(const Vec3& p) const {
  return radius_m - kRounding_m - std::hypot(p.x() - x, p.z() - z);
}

// Returns the columns or rows whose coordinate without noise lies within reach of the centre.
NoisyGridSearch::Range NoisyGridSearch::within(double centre, double reach, double start, double spacing,
                                               int count) {
  const auto clamped = [count](double place) {
    return static_cast<int>(std::clamp(place, -1.0, static_cast<double>(count)));
  };
  return {std::max(0, clamped(std::ceil((centre - reach - start) / spacing))),
          std::min(count - 1, clamped(std::floor((centre + reach - start) / spacing)))};
}

// Selects the points that can move into the cylinder, by their random words, and then computes their noise.
void NoisyGridSearch::make(const Cylinder& cylinder, const Kernels& kernels) const {
  const double inner = cylinder.radius_m + kRounding_m, reach = inner + kMaxNormal * sigma_m_;
  const Range columns = within(cylinder.x, reach, grid_.x(0), grid_.spacing_m, grid_.columns);
  const Range rows = within(cylinder.z, reach, grid_.z(0), grid_.spacing_m, grid_.rows);
  // A point at this offset from the axis must be moved towards the axis by its noise, by `outside` or more.
  const auto bounds = [&](double offset) {
    const double outside = std::abs(offset) - inner;
    return outside > 0 ? word_bounds(outside / sigma_m_, -offset) : word_bounds(0, 0);
  };
  const auto width = static_cast<std::size_t>(std::max(0, columns.last - columns.first + 1)),
             height = static_cast<std::size_t>(std::max(0, rows.last - rows.first + 1));
  for (std::size_t i = 0; i < width; ++i)
    x_bounds_[i] = bounds(grid_.x(columns.first + static_cast<int>(i)) - cylinder.x);
  for (std::size_t i = 0; i < height; ++i)
    z_bounds_[i] = bounds(grid_.z(rows.first + static_cast<int>(i)) - cylinder.z);
  const auto stride = static_cast<std::uint32_t>(grid_.columns),
             first =
                 static_cast<std::uint32_t>(rows.first) * stride + static_cast<std::uint32_t>(columns.first);
  const std::size_t candidates = kernels.noise.candidates(stream_, {first, stride, width, height},
                                                          x_bounds_.data(), z_bounds_.data(), index_.data());
  make_points(candidates, cylinder, kernels);
  cached_cylinder_ = cylinder;
  near_ball_.radius = -1;
}

PointRun NoisyGridSearch::run(std::size_t first, std::size_t count) const {
  return {x_.data() + first,
          y_.data() + first,
          z_.data() + first,
          nullptr,
          nullptr,
          index_.data() + first,
          0,
          count};
}

// Returns the points of the cylinder that are near the ball, the ball's own points included. pre: the
// cylinder holds the ball.
PointRun NoisyGridSearch::near(const Ball& ball, const Kernels& kernels) const {
  if ((ball.centre - near_ball_.centre).norm() + ball.radius + kRounding_m > near_ball_.radius) {
    near_ball_ = {ball.centre, std::min(ball.radius + kNearMargin_m, cached_cylinder_.margin_m(ball.centre))};
    const PointSink behind{x_.data() + count_,    y_.data() + count_, z_.data() + count_, nullptr, nullptr,
                           index_.data() + count_};
    near_count_ =
        kernels.gather.append_within(run(0, count_), near_ball_.centre.data(), near_ball_.radius, behind, 0);
  }
  return run(count_, near_count_);
}

// Computes the noisy points of the first `candidates` indices and keeps those inside the cylinder.
void NoisyGridSearch::make_points(std::size_t candidates, const Cylinder& cylinder,
                                  const Kernels& kernels) const {
  constexpr std::size_t kChunk = 256;
  double nx[kChunk] = {}, ny[kChunk] = {}, nz[kChunk] = {};
  const double squared = cylinder.radius_m * cylinder.radius_m;
  const auto columns = static_cast<std::uint32_t>(grid_.columns);
  std::uint32_t row_start = 0;  // indices increase, so that a new row is rare
  double row_z = 0;
  count_ = 0;
  for (std::size_t done = 0; done < candidates; done += kChunk) {
    const std::size_t chunk = std::min(kChunk, candidates - done);
    if (sigma_m_ > 0) kernels.noise.normals(stream_, index_.data() + done, chunk, nx, ny, nz);
    for (std::size_t i = 0; i < chunk; ++i) {
      const std::uint32_t point = index_[done + i];
      if (point - row_start >= columns || (done == 0 && i == 0)) {
        row_start = point / columns * columns;
        row_z = grid_.z(static_cast<int>(point / columns));
      }
      const double x = grid_.x(static_cast<int>(point - row_start)) + sigma_m_ * nx[i];
      const double z = row_z + sigma_m_ * nz[i];
      const double dx = x - cylinder.x, dz = z - cylinder.z;
      // Every candidate is stored at the end of the list. The end advances only for those inside.
      x_[count_] = x, y_[count_] = height_m_ + sigma_m_ * ny[i], z_[count_] = z;
      index_[count_] = point;
      count_ += dx * dx + dz * dz <= squared ? 1 : 0;
    }
  }
}

void NoisyGridSearch::gather(const Ball& ball, const Kernels& kernels, GatheredPoints& out) const {
  const double reach = ball.radius + kMaxNormal * sigma_m_ + kRounding_m;
  if (!ball.centre.allFinite() || std::abs(ball.centre.y() - height_m_) > reach) return;
  const bool is_of_proxy = ball.radius <= kMaxOfProxy_m;
  if (cached_cylinder_.margin_m(ball.centre) < ball.radius)
    make({ball.centre.x(), ball.centre.z(), ball.radius + (is_of_proxy ? kSpareMargin_m : 0)}, kernels);
  out.add(is_of_proxy ? near(ball, kernels) : run(0, count_), ball, kernels);
}

}  // namespace remote_touch
