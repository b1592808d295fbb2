#include "analysis/trace/image_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "analysis/trace/interval_estimates.h"
#include "core/points/number_columns.h"

namespace remote_touch {
namespace {

constexpr std::size_t kFewestSamples = 20, kFewestDepths = 10;
constexpr double kLargestStep = 2;  // unit: the median step

bool is_between(double value, double low, double high) {
  return value >= low && value < high;
}

// The noise of one pixel; NaN if a frame has no depth.
DepthNoise noise_of_pixel(std::span<const DepthImage> frames, std::size_t pixel) {
  const auto count = static_cast<double>(frames.size());
  double depths_m = 0, inverses = 0, squares = 0;
  for (const DepthImage& frame : frames) depths_m += frame.z_m[pixel], inverses += 1 / frame.z_m[pixel];
  const double mean = inverses / count;
  for (const DepthImage& frame : frames) {
    const double deviation = 1 / frame.z_m[pixel] - mean;
    squares += deviation * deviation;
  }
  return {depths_m / count, std::sqrt(squares / (count - 1))};
}

// Fits the plane to the square at (u, v). The columns and rows of a full square, counted from its middle, are
// orthogonal to each other and to 1, so that each coefficient is a mean by itself.
std::optional<FittedWindow> fitted_window(const DepthImage& depth, int u, int v, int width) {
  FittedWindow window{u, v, width, 0, 0, 0, {}};
  const auto pixels = static_cast<double>(width * width);
  const double variance = (static_cast<double>(width * width) - 1) / 12;  // variance of the columns
  const auto for_pixels = [&](auto&& use) {
    for (int row = 0; row < width; ++row)
      for (int column = 0; column < width; ++column) {
        const double z = depth.z_m[static_cast<std::size_t>(v + row) * static_cast<std::size_t>(depth.width) +
                                   static_cast<std::size_t>(u + column)];
        use(1 / z, column - 0.5 * (width - 1), row - 0.5 * (width - 1));
      }
  };
  for_pixels([&](double inverse, double across, double down) {
    window.inverse_per_m += inverse / pixels;
    window.across_per_m += inverse * across / (pixels * variance);
    window.down_per_m += inverse * down / (pixels * variance);
  });
  if (std::isnan(window.inverse_per_m)) return std::nullopt;
  double squares = 0;
  for_pixels([&](double inverse, double across, double down) {
    const double residual =
        inverse - window.inverse_per_m - window.across_per_m * across - window.down_per_m * down;
    squares += residual * residual;
  });
  window.noise = {1 / window.inverse_per_m, std::sqrt(squares / (pixels - 3))};
  return window;
}

}  // namespace

std::vector<DepthNoise> temporal_noise(std::span<const DepthImage> frames) {
  if (frames.size() < 2) throw std::invalid_argument("temporal noise: expected two frames or more");
  for (const DepthImage& frame : frames)
    if (frame.width != frames[0].width || frame.z_m.size() != frames[0].z_m.size())
      throw std::invalid_argument("temporal noise: expected frames of one size");
  std::vector<DepthNoise> noise;
  for (std::size_t i = 0; i < frames[0].z_m.size(); ++i) {
    const DepthNoise of_pixel = noise_of_pixel(frames, i);
    if (!std::isnan(of_pixel.per_m)) noise.push_back(of_pixel);
  }
  return noise;
}

double FittedWindow::depth_at(int column, int row) const {
  const double middle = 0.5 * (width_px - 1);
  return 1 / (inverse_per_m + across_per_m * (column - u - middle) + down_per_m * (row - v - middle));
}

std::vector<FittedWindow> fitted_windows(const DepthImage& depth, int width_px) {
  std::vector<FittedWindow> windows;
  for (int v = 0; v + width_px <= depth.height; v += width_px)
    for (int u = 0; u + width_px <= depth.width; u += width_px)
      if (const auto window = fitted_window(depth, u, v, width_px)) windows.push_back(*window);
  return windows;
}

DepthNoise noise_quantile(std::span<const DepthNoise> samples, double near_m, double far_m, double share) {
  std::vector<double> per_m;
  double depths_m = 0;
  for (const DepthNoise& sample : samples)
    if (is_between(sample.depth_m, near_m, far_m)) per_m.push_back(sample.per_m), depths_m += sample.depth_m;
  if (per_m.size() < kFewestSamples) return {};
  return {depths_m / static_cast<double>(per_m.size()), quantile_in_place(per_m, share)};
}

double depth_step_per_m(std::span<const DepthImage> frames, double near_m, double far_m) {
  std::vector<double> depths_m;
  for (const DepthImage& frame : frames)
    for (const double z : frame.z_m)
      if (is_between(z, near_m, far_m)) depths_m.push_back(z);
  std::sort(depths_m.begin(), depths_m.end());
  depths_m.erase(std::unique(depths_m.begin(), depths_m.end()), depths_m.end());
  if (depths_m.size() < kFewestDepths) return kNoValue;
  std::vector<double> steps;
  for (std::size_t i = 1; i < depths_m.size(); ++i) steps.push_back(1 / depths_m[i - 1] - 1 / depths_m[i]);
  const double largest = kLargestStep * median_in_place(steps);
  double sum = 0, count = 0;
  for (const double step : steps)
    if (step <= largest) sum += step, ++count;
  return sum / count;
}

std::vector<DepthEdge> depth_edges(const DepthImage& depth, double min_jump_per_m) {
  std::vector<DepthEdge> edges;
  for (int v = 0; v < depth.height; ++v) {
    const double* z_m = &depth.z_m[static_cast<std::size_t>(v) * static_cast<std::size_t>(depth.width)];
    int last = -1;  // column of the last measured pixel
    for (int u = 0; u < depth.width; ++u) {
      if (!(z_m[u] > 0)) continue;
      const double jump = last < 0 ? 0 : 1 / z_m[u] - 1 / z_m[last];
      if (std::abs(jump) >= min_jump_per_m) edges.push_back({jump > 0, std::abs(jump), u - last - 1});
      last = u;
    }
  }
  return edges;
}

std::vector<DepthEdge> edges_between(std::span<const DepthEdge> edges, bool is_left_of_near, double low_per_m,
                                     double high_per_m) {
  std::vector<DepthEdge> chosen;
  for (const DepthEdge& edge : edges)
    if (edge.is_left_of_near == is_left_of_near && is_between(edge.jump_per_m, low_per_m, high_per_m))
      chosen.push_back(edge);
  return chosen;
}

double hole_fraction(std::span<const DepthEdge> edges, int distance_px) {
  if (edges.empty()) return kNoValue;
  const auto holes =
      std::count_if(edges.begin(), edges.end(), [&](const DepthEdge& e) { return e.hole_px >= distance_px; });
  return static_cast<double>(holes) / static_cast<double>(edges.size());
}

double median_hole_px(std::span<const DepthEdge> edges) {
  if (edges.size() < kFewestSamples) return kNoValue;
  std::vector<double> widths;
  for (const DepthEdge& edge : edges) widths.push_back(edge.hole_px);
  return median_in_place(widths);
}

namespace {

double fraction(int events, int of) {
  return of > 0 ? static_cast<double>(events) / of : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

SegmentationScore& SegmentationScore::operator+=(const SegmentationScore& other) {
  found += other.found, missed += other.missed, wrong += other.wrong;
  of_class_without_depth += other.of_class_without_depth;
  return *this;
}

double SegmentationScore::recall() const {
  return fraction(found, found + missed);
}
double SegmentationScore::precision() const {
  return fraction(found, selected());
}
double SegmentationScore::depth_fraction() const {
  return fraction(found + missed, found + missed + of_class_without_depth);
}
std::pair<double, double> SegmentationScore::recall_interval() const {
  return exact_interval(found, found + missed);
}
std::pair<double, double> SegmentationScore::precision_interval() const {
  return exact_interval(found, selected());
}

SegmentationScore score_segmentation(const std::vector<char>& selected, const std::vector<char>& of_class,
                                     const std::vector<char>& has_depth) {
  if (selected.size() != of_class.size() || selected.size() != has_depth.size())
    throw std::invalid_argument("score_segmentation: columns differ in length");
  SegmentationScore score;
  for (std::size_t i = 0; i < selected.size(); ++i) {
    if (!has_depth[i])
      score.of_class_without_depth += of_class[i] ? 1 : 0;
    else if (of_class[i])
      ++(selected[i] ? score.found : score.missed);
    else if (selected[i])
      ++score.wrong;
  }
  return score;
}

}  // namespace remote_touch
