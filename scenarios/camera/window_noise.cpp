#include "scenarios/camera/window_noise.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace remote_touch {

namespace {

// The normals of one row of the image, which is widened by the reach of the window.
struct WidenedRow {
  std::vector<std::uint32_t> index;
  std::vector<double> x, y, z;

  WidenedRow(int row, std::size_t width, const NoiseStream& stream, const Kernels& kernels)
      : index(width), x(width), y(width), z(width) {
    std::iota(index.begin(), index.end(),
              static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(width));
    kernels.noise.normals(stream, index.data(), width, x.data(), y.data(), z.data());
  }
};

}  // namespace

WindowNoise window_noise(int width, int height, int window_px, bool also_independent,
                         const NoiseStream& stream, const Kernels& kernels) {
  const auto columns = static_cast<std::size_t>(width), window = static_cast<std::size_t>(window_px);
  const std::size_t pixels = columns * static_cast<std::size_t>(height);
  const int rows = height + window_px - 1;
  WindowNoise noise;
  noise.averaged.resize(pixels);
  if (also_independent) noise.across.resize(pixels), noise.down.resize(pixels);
  // Sums over the window's columns, for each row that a window reaches.
  std::vector<double> sums(columns * static_cast<std::size_t>(rows));
#pragma omp parallel for schedule(static)
  for (int v = 0; v < rows; ++v) {
    const WidenedRow row(v, columns + window - 1, stream, kernels);
    const std::size_t first = columns * static_cast<std::size_t>(v);
    for (std::size_t u = 0; u < columns; ++u)
      for (std::size_t k = 0; k < window; ++k) sums[first + u] += row.x[u + k];
    if (!also_independent || v >= height) continue;
    std::copy_n(row.y.begin(), columns, noise.across.begin() + static_cast<std::ptrdiff_t>(first));
    std::copy_n(row.z.begin(), columns, noise.down.begin() + static_cast<std::ptrdiff_t>(first));
  }
#pragma omp parallel for schedule(static)
  for (int v = 0; v < height; ++v) {
    const std::size_t first = columns * static_cast<std::size_t>(v);
    for (std::size_t u = 0; u < columns; ++u) {
      double sum = 0;
      for (std::size_t k = 0; k < window; ++k) sum += sums[first + k * columns + u];
      noise.averaged[first + u] = sum / window_px;
    }
  }
  return noise;
}

}  // namespace remote_touch
