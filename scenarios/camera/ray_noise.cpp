#include "scenarios/camera/ray_noise.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

// Limit for the nodes of a lattice: their numbers and their noise need about 600 MB.
constexpr std::int64_t kMaxNodes = std::int64_t{1} << 24;

// Returns a standard normal for each number (of a point or a node), correlated with those of other frames.
// Frames that are `span` apart are independent but for kNegligible. Between two of them, each at the distance
// h of the frame in their middle, that frame is m^h / (1 + m^(2 h)) times their sum, plus new noise; then the
// same within the half that contains the wanted frame, until the wanted frame is in the middle.
std::vector<double> remembered(const std::vector<std::uint32_t>& numbers, double memory, const NoiseKey& key,
                               int frame, const Kernels& kernels) {
  constexpr double kNegligible = 1e-8;
  std::vector<double> unused(numbers.size());
  const auto independent = [&](std::int64_t of_frame) {
    std::vector<double> x(numbers.size());
    const NoiseStream stream = noise_stream(key, NoiseUse::sensor_ray, static_cast<std::uint32_t>(of_frame));
    kernels.noise.normals(stream, numbers.data(), numbers.size(), x.data(), unused.data(), unused.data());
    return x;
  };
  std::vector<double> kept{memory};  // m, m^2, m^4, ...
  while (kept.back() > kNegligible) kept.push_back(kept.back() * kept.back());
  std::int64_t half = std::int64_t{1} << (kept.size() - 1), begin = frame / half * half;
  std::vector<double> before = independent(begin);
  if (begin == frame) return before;
  std::vector<double> after = independent(begin + half);
  for (std::size_t level = kept.size() - 1; level-- > 0;) {
    half /= 2;
    const double m = kept[level], share = m / (1 + m * m), rest = std::sqrt((1 - m * m) / (1 + m * m));
    std::vector<double> middle = independent(begin + half);
    for (std::size_t i = 0; i < middle.size(); ++i)
      middle[i] = share * (before[i] + after[i]) + rest * middle[i];
    if (begin + half == frame) return middle;
    if (frame < begin + half)
      after = std::move(middle);
    else
      before = std::move(middle), begin += half;
  }
  return before;
}

// Nodes of a lattice around all points of a frame.
struct Lattice {
  double pitch;
  int first_x = 0, first_z = 0, columns = 0, rows = 0;

  Lattice(const PointCloud& positions, double pitch_m) : pitch(pitch_m) {
    double low_x = std::numeric_limits<double>::infinity(), high_x = -low_x, low_z = low_x, high_z = -low_x;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      if (!positions.is_measured(i)) continue;
      low_x = std::min(low_x, positions.x[i]), high_x = std::max(high_x, positions.x[i]);
      low_z = std::min(low_z, positions.z[i]), high_z = std::max(high_z, positions.z[i]);
    }
    if (!(low_x <= high_x)) return;
    first_x = cell(low_x), first_z = cell(low_z);
    columns = cell(high_x) - first_x + 2, rows = cell(high_z) - first_z + 2;
    if (std::int64_t{columns} * rows > kMaxNodes)
      throw InputError("faults.ray_noise_correlation_m",
                       "needs a lattice of " + std::to_string(columns) + " x " + std::to_string(rows) +
                           " nodes over the points of a frame: expected a larger value, for at most " +
                           std::to_string(kMaxNodes) + " nodes, or 0");
  }
  // Positions beyond 30000 pitches all count as the outermost cell, so that a node's number stays in range.
  int cell(double place) const {
    return static_cast<int>(std::floor(std::clamp(place / pitch, -30000.0, 30000.0)));
  }
  // The number of a node, and so its noise, depends only on its position and not on the frame's lattice.
  std::vector<std::uint32_t> numbers() const {
    std::vector<std::uint32_t> all;
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column)
        all.push_back(static_cast<std::uint32_t>(first_z + row + 32768) << 16 |
                      static_cast<std::uint32_t>(first_x + column + 32768));
    return all;
  }
  double interpolate(const std::vector<double>& values, double x, double z) const {
    const int column = cell(x), row = cell(z);
    const double fx = std::clamp(x / pitch - column, 0.0, 1.0), fz = std::clamp(z / pitch - row, 0.0, 1.0);
    const double weights[] = {(1 - fx) * (1 - fz), fx * (1 - fz), (1 - fx) * fz, fx * fz};
    double sum = 0, squares = 0;
    for (int corner = 0; corner < 4; ++corner) {
      const auto node =
          static_cast<std::size_t>((row - first_z + corner / 2) * columns + column - first_x + corner % 2);
      sum += weights[corner] * values[node];
      squares += weights[corner] * weights[corner];
    }
    return sum / std::sqrt(squares);
  }
};

}  // namespace

std::vector<double> standard_noise(const RayNoise& noise, const PointCloud& positions, const NoiseKey& key,
                                   int frame, const Kernels& kernels) {
  if (noise.correlation_m == 0) {
    std::vector<std::uint32_t> numbers(positions.size());
    std::iota(numbers.begin(), numbers.end(), 0u);
    return remembered(numbers, noise.memory, key, frame, kernels);
  }
  const Lattice lattice(positions, noise.correlation_m);
  const std::vector<double> nodes = remembered(lattice.numbers(), noise.memory, key, frame, kernels);
  std::vector<double> values(positions.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (positions.is_measured(i)) values[i] = lattice.interpolate(nodes, positions.x[i], positions.z[i]);
  return values;
}

}  // namespace remote_touch
