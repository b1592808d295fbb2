#include "tests/benchmarks/peers/published_normals.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace remote_touch::peers {

void BoxFilter::run(const DepthOfCamera& from, int window, std::vector<float>& to) {
  to = from.z_m;
  if (window == 1) return;
  const int width = from.width, height = from.height, half = window / 2;
  const auto row = [&](int v) { return from.z_m.data() + static_cast<std::ptrdiff_t>(v) * width; };
  columns_.assign(static_cast<std::size_t>(width), 0);
  const auto add_row = [&](int v, double sign) {
    const float* const z = row(v);
    for (int u = 0; u < width; ++u) columns_[static_cast<std::size_t>(u)] += sign * z[u];
  };
  for (int v = 0; v < std::min(half, height); ++v) add_row(v, 1);
  for (int v = 0; v < height; ++v) {
    if (v + half < height) add_row(v + half, 1);
    if (v - half - 1 >= 0) add_row(v - half - 1, -1);
    const int rows = std::min(v + half, height - 1) - std::max(v - half, 0) + 1;
    double sum = 0;
    for (int u = 0; u < std::min(half, width); ++u) sum += columns_[static_cast<std::size_t>(u)];
    float* const out = to.data() + static_cast<std::ptrdiff_t>(v) * width;
    for (int u = 0; u < width; ++u) {
      if (u + half < width) sum += columns_[static_cast<std::size_t>(u + half)];
      if (u - half - 1 >= 0) sum -= columns_[static_cast<std::size_t>(u - half - 1)];
      const int columns = std::min(u + half, width - 1) - std::max(u - half, 0) + 1;
      out[u] = static_cast<float>(sum / (rows * columns));
    }
  }
}

namespace {

// One row of an image with its neighbours.
struct Rows {
  const float* z;
  std::ptrdiff_t width;
  float focal, ray_y, step;  // step is 1 / focal
  float cx;
  float at(int u, int i, int j) const { return z[u + i + j * width]; }
};

constexpr int kNeighbours[8][2] = {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};

void order(float& a, float& b) {
  const float low = std::min(a, b);
  b = std::max(a, b), a = low;
}

// Returns the mean of the two values in the middle, by Batcher's network of 19 exchanges.
float median(float x[8]) {
  constexpr int kExchanges[19][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6},
                                     {5, 7}, {1, 2}, {5, 6}, {0, 4}, {3, 7}, {1, 5}, {2, 6},
                                     {1, 4}, {3, 6}, {2, 4}, {3, 5}, {3, 4}};
#pragma GCC unroll 19
  for (const auto& [a, b] : kExchanges) order(x[a], x[b]);
  return 0.5f * (x[3] + x[4]);
}

struct Normal {
  float x, y, z;
};

template <bool kMedian>
inline Normal three_filters(const Rows& rows, int u) {
  const float nx = 0.5f * rows.focal * (1 / rows.at(u, 1, 0) - 1 / rows.at(u, -1, 0));
  const float ny = 0.5f * rows.focal * (1 / rows.at(u, 0, 1) - 1 / rows.at(u, 0, -1));
  const float z0 = rows.at(u, 0, 0), ray_x = (static_cast<float>(u) - rows.cx) * rows.step;
  float nz[8], sum = 0, count = 0;
#pragma GCC unroll 8
  for (int k = 0; k < 8; ++k) {
    const float i = static_cast<float>(kNeighbours[k][0]), j = static_cast<float>(kNeighbours[k][1]);
    const float z = rows.at(u, kNeighbours[k][0], kNeighbours[k][1]), dz = z - z0;
    const float dx = ray_x * dz + i * rows.step * z, dy = rows.ray_y * dz + j * rows.step * z;
    // A neighbour at the same depth gives no estimate of n_z. If all are at the same depth, the plane faces
    // the camera.
    const bool has_depth_step = std::abs(dz) > 1e-7f;
    nz[k] = has_depth_step ? -(nx * dx + ny * dy) / dz : -1e3f;
    sum += has_depth_step ? nz[k] : 0, count += has_depth_step ? 1.0f : 0.0f;
  }
  if constexpr (kMedian) return {nx, ny, median(nz)};
  return {nx, ny, count > 0 ? sum / count : -1e3f};
}

inline float discontinuity_aware(float far_left, float left, float z, float right, float far_right) {
  const float bend_left = std::abs(far_left - 2 * left + z) + 1e-6f;
  const float bend_right = std::abs(z - 2 * right + far_right) + 1e-6f;
  return ((z - left) * bend_right + (right - z) * bend_left) / (bend_left + bend_right);
}

template <bool kDiscontinuities>
inline Normal d2nt(const Rows& rows, int u) {
  const float z = rows.at(u, 0, 0);
  float zu = 0.5f * (rows.at(u, 1, 0) - rows.at(u, -1, 0)),
        zv = 0.5f * (rows.at(u, 0, 1) - rows.at(u, 0, -1));
  if constexpr (kDiscontinuities) {
    zu = discontinuity_aware(rows.at(u, -2, 0), rows.at(u, -1, 0), z, rows.at(u, 1, 0), rows.at(u, 2, 0));
    zv = discontinuity_aware(rows.at(u, 0, -2), rows.at(u, 0, -1), z, rows.at(u, 0, 1), rows.at(u, 0, 2));
  }
  const float down = rows.ray_y * rows.focal;
  return {rows.focal * zu, rows.focal * zv, -(z + (static_cast<float>(u) - rows.cx) * zu + down * zv)};
}

template <Normal (*kNormal)(const Rows&, int)>
void all_rows(const DepthOfCamera& camera, const std::vector<float>& z_m, std::vector<float>& normals) {
  const std::ptrdiff_t width = camera.width;
  for (int v = 2; v + 2 < camera.height; ++v) {
    const Rows rows{z_m.data() + v * width, width,
                    camera.focal,           (static_cast<float>(v) - camera.cy) / camera.focal,
                    1 / camera.focal,       camera.cx};
    float* const out = normals.data() + 3 * v * width;
#pragma omp simd
    for (int u = 2; u < camera.width - 2; ++u) {
      const Normal n = kNormal(rows, u);
      const float factor = 1 / std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
      out[3 * u] = n.x * factor, out[3 * u + 1] = n.y * factor, out[3 * u + 2] = n.z * factor;
    }
  }
}

// Fills row v, from its second column to the last but one.
void bend_row(const std::vector<float>& z_m, std::ptrdiff_t width, std::ptrdiff_t v, float* bend_m) {
  const float* const z = z_m.data() + v * width;
#pragma omp simd
  for (std::ptrdiff_t u = 1; u < width - 1; ++u)
    bend_m[u] = std::abs(z[u - 1] + z[u + 1] + z[u - width] + z[u + width] - 4 * z[u]);
}

// Writes for each pixel the offset, in the image's index, to the least bent pixel among the pixel and its 4
// neighbours.
void best_of_row(const float* above, const float* here, const float* below, int width, int* away) {
#pragma omp simd
  for (int u = 3; u < width - 3; ++u) {
    float min_m = here[u];
    int best = 0;
    best = here[u - 1] < min_m ? -1 : best, min_m = std::min(here[u - 1], min_m);
    best = here[u + 1] < min_m ? 1 : best, min_m = std::min(here[u + 1], min_m);
    best = above[u] < min_m ? -width : best, min_m = std::min(above[u], min_m);
    best = below[u] < min_m ? width : best;
    away[u] = best;
  }
}

}  // namespace

void NormalTranslator::refine(const DepthOfCamera& camera, const std::vector<float>& z_m,
                              std::vector<float>& normals) {
  const std::ptrdiff_t width = camera.width, height = camera.height;
  bend_m_.resize(static_cast<std::size_t>(3 * width)), away_.resize(static_cast<std::size_t>(width));
  const auto bend = [&](std::ptrdiff_t v) { return bend_m_.data() + v % 3 * width; };
  for (std::ptrdiff_t v = 2; v < 4; ++v) bend_row(z_m, width, v, bend(v));
  for (std::ptrdiff_t v = 3; v < height - 3; ++v) {
    bend_row(z_m, width, v + 1, bend(v + 1));
    best_of_row(bend(v - 1), bend(v), bend(v + 1), camera.width, away_.data());
    const float* const from = unrefined_.data() + 3 * v * width;
    float* const to = normals.data() + 3 * v * width;
    for (std::ptrdiff_t u = 3; u < width - 3; ++u)
      std::copy_n(from + 3 * (u + away_[static_cast<std::size_t>(u)]), 3, to + 3 * u);
  }
}

void NormalTranslator::run(Translator how, const DepthOfCamera& camera, const std::vector<float>& z_m,
                           std::vector<float>& normals) {
  const std::size_t size = 3 * z_m.size();
  if (normals.size() != size) normals.assign(size, std::numeric_limits<float>::quiet_NaN());
  switch (how) {
    case Translator::three_filters_mean:
      return all_rows<three_filters<false>>(camera, z_m, normals);
    case Translator::three_filters_median:
      return all_rows<three_filters<true>>(camera, z_m, normals);
    case Translator::d2nt:
      return all_rows<d2nt<false>>(camera, z_m, normals);
    case Translator::d2nt_discontinuities:
      return all_rows<d2nt<true>>(camera, z_m, normals);
    case Translator::d2nt_refined:
      unrefined_.resize(size);
      all_rows<d2nt<true>>(camera, z_m, unrefined_);
      return refine(camera, z_m, normals);
  }
}

}  // namespace remote_touch::peers
