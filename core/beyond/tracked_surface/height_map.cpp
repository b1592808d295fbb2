#include "core/beyond/tracked_surface/height_fit.h"

#include <limits>

namespace remote_touch {

PatchFrame::PatchFrame(const Vec3& origin_W, const Vec3& normal_W, double contact_radius_m)
    : origin_W_(origin_W), n_W_(normal_W), unit_m_(contact_radius_m) {
  int min = 0;
  normal_W.cwiseAbs().minCoeff(&min);
  u_W_ = normal_W.cross(Vec3::Unit(min)).normalized();
  v_W_ = normal_W.cross(u_W_);
}

void HeightProfile::clear(double half_range) {
  const int half = static_cast<int>(std::ceil(std::min(half_range, kMaxRange) / kBin));
  bins_ = std::min(2 * half, kMaxBins);
  half_range_ = 0.5 * bins_ * kBin;
  std::fill_n(count_.begin(), bins_ + 1, 0.0);
}

void HeightProfile::add_bins(const std::int32_t* bin, std::size_t number) {
  for (std::size_t i = 0; i < number; ++i) count_[static_cast<std::size_t>(bin[i])] += 1;
}

double HeightProfile::max() const {
  return bins_ == 0 ? 0 : *std::max_element(count_.begin(), count_.begin() + bins_);
}

// Applies a box filter twice, which is a triangular filter.
HeightProfile HeightProfile::smoothed(double sigma) const {
  HeightProfile result = *this;
  const int half = std::max(1, static_cast<int>(std::round(1.2 * sigma / kBin)));
  result.window_ = 1.5 * (2 * half + 1);
  std::array<double, kMaxBins + 1> sums;
  sums[0] = 0;
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < bins_; ++i)
      sums[static_cast<std::size_t>(i + 1)] = sums[static_cast<std::size_t>(i)] + result.count(i);
    for (int i = 0; i < bins_; ++i)
      result.count_[static_cast<std::size_t>(i)] =
          (sums[static_cast<std::size_t>(std::min(bins_, i + half + 1))] -
           sums[static_cast<std::size_t>(std::max(0, i - half))]) /
          (2 * half + 1);
  }
  return result;
}

// Sums for all shifts together, bin by bin, so that empty bins cost nothing.
double HeightProfile::shift_of(const HeightProfile& other, double reach) const {
  constexpr double kNearness = 0.1;  // relative reduction of a sum at the end of the reach
  const int max = std::min(static_cast<int>(std::round(reach / kBin)), kMaxBins);
  const int offset = (other.bins_ - bins_) / 2;
  std::array<double, 2 * kMaxBins + 1> products;
  std::fill_n(products.begin(), 2 * max + 1, 0.0);
  for (int b = 0; b < bins_; ++b) {
    const double here = count(b);
    if (here == 0) continue;
    const int middle = b + offset;  // bin of the same height in the other profile
    for (int k = std::max(-max, -middle); k <= std::min(max, other.bins_ - 1 - middle); ++k)
      products[static_cast<std::size_t>(max + k)] += here * other.count(middle + k);
  }
  double best = -1;
  int at = 0;
  for (int step = 0; step <= 2 * max; ++step) {
    const int k = step % 2 == 0 ? step / 2 : -(step + 1) / 2;
    const double sum =
        products[static_cast<std::size_t>(max + k)] * (1 - kNearness * (k * k) / (max * max + 1.0));
    if (sum > best) best = sum, at = k;
  }
  return at * kBin;
}

double HeightProfile::valley_from(double height, int direction) const {
  if (bins_ == 0) return 0;
  const int start = std::clamp(static_cast<int>((height + half_range_) / kBin), 0, bins_ - 1);
  const double peak = count(start);
  constexpr double kSure = 4, kPeakFraction = 0.15;
  double min = peak;
  int where = start;
  for (int b = start; b >= 0 && b < bins_; b += direction) {
    if (count(b) < min) min = count(b), where = b;
    if (where == start) continue;
    const double chance = kSure * std::sqrt((min + 1) / window_);
    if (count(b) > min + kPeakFraction * peak + chance) return std::abs(centre(where) - height);
  }
  return 2 * half_range_;
}

namespace {

int nearest_index(double x) {
  return static_cast<int>(
      std::clamp((x + HeightMap::kHalf) / HeightMap::kNodePitch + 0.5, 0.0, HeightMap::kNodes - 1.0));
}

}  // namespace

const HeightMap::Node& HeightMap::nearest_node(double u, double v) const {
  return node(nearest_index(u), nearest_index(v));
}

double HeightMap::error(double u, double v) const {
  const int i = nearest_index(u), j = nearest_index(v);
  if (node(i, j).known) return node(i, j).error;
  double largest = -1;
  for (int b = std::max(0, j - 1); b <= std::min(kNodes - 1, j + 1); ++b)
    for (int a = std::max(0, i - 1); a <= std::min(kNodes - 1, i + 1); ++a)
      if (node(a, b).known) largest = std::max(largest, node(a, b).error);
  return largest >= 0 ? largest : std::numeric_limits<double>::infinity();
}

// The height at a corner is the mean of the planes of the known nodes next to it; NaN if there is none.
void HeightMap::fill_cells() {
  struct Mean {
    double sum = 0, count = 0;
    void add(const Node& n, double du, double dv) {
      const double height = n.height + n.slope_u * du + n.slope_v * dv;
      sum += n.known ? height : 0, count += n.known ? 1 : 0;
    }
    double value() const { return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN(); }
  };
  constexpr double kUp = kCell, kDown = -kCell;  // offsets of a corner from the nodes before and after it
  for (int j = 0; j < kCorners; ++j) {
    const bool between = j % 2 != 0;
    const Node *low = &node(0, j / 2), *high = &node(0, (j + 1) / 2);
    double* corner = &corner_[static_cast<std::size_t>(j * kCorners)];
    for (int a = 0; a < kNodes; ++a) {
      Mean at;
      at.add(low[a], 0, between ? kUp : 0);
      if (between) at.add(high[a], 0, kDown);
      corner[2 * a] = at.value();
      if (a + 1 == kNodes) break;
      Mean beside;
      beside.add(low[a], kUp, between ? kUp : 0), beside.add(low[a + 1], kDown, between ? kUp : 0);
      if (between) beside.add(high[a], kUp, kDown), beside.add(high[a + 1], kDown, kDown);
      corner[2 * a + 1] = beside.value();
    }
  }
}

void HeightMap::set_plane(double height, double slope_u, double slope_v, double radius) {
  for (int j = 0; j < kNodes; ++j)
    for (int i = 0; i < kNodes; ++i) {
      const double u = node_at(i), v = node_at(j);
      const bool inside = u * u + v * v <= radius * radius;
      node(i, j) = {height + slope_u * u + slope_v * v, slope_u, slope_v, 0, inside, inside};
    }
  fill_cells();
}

void HeightMap::extend(int rings) {
  for (int ring = 0; ring < rings; ++ring) {
    if (std::all_of(nodes_.begin(), nodes_.end(), [](const Node& n) { return n.known; })) break;
    const auto before = nodes_;
    for (int j = 0; j < kNodes; ++j)
      for (int i = 0; i < kNodes; ++i) {
        if (node(i, j).known) continue;
        Node sum;
        int count = 0;
        for (int b = std::max(0, j - 1); b <= std::min(kNodes - 1, j + 1); ++b)
          for (int a = std::max(0, i - 1); a <= std::min(kNodes - 1, i + 1); ++a) {
            const Node& n = before[static_cast<std::size_t>(b * kNodes + a)];
            if (!n.known) continue;
            sum.height += n.height + kNodePitch * (n.slope_u * (i - a) + n.slope_v * (j - b));
            sum.slope_u += n.slope_u, sum.slope_v += n.slope_v;
            ++count;
          }
        if (count > 0)
          node(i, j) = {sum.height / count, sum.slope_u / count, sum.slope_v / count, 0, true, false};
      }
  }
  fill_cells();
}

void HeightMap::shrink_change_since(const HeightMap& earlier) {
  constexpr double kLever = 3;  // rms distance of a wide window's points from its middle, contact radii
  const auto keep = [](double& now, double before, double error) {
    now = before + shrunk(now - before, error);
  };
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Node& now = nodes_[i];
    const Node& before = earlier.nodes_[i];
    if (!now.covered || !before.covered) continue;
    const double error = error_of_two(now.error);
    keep(now.height, before.height, error);
    keep(now.slope_u, before.slope_u, error / kLever), keep(now.slope_v, before.slope_v, error / kLever);
  }
  fill_cells();
}

void HeightMap::add_plane(double height, double slope_u, double slope_v) {
  for (int j = 0; j < kNodes; ++j)
    for (int i = 0; i < kNodes; ++i) {
      node(i, j).height += height + slope_u * node_at(i) + slope_v * node_at(j);
      node(i, j).slope_u += slope_u, node(i, j).slope_v += slope_v;
    }
  for (int j = 0; j < kCorners; ++j)
    for (int i = 0; i < kCorners; ++i)
      corner_[static_cast<std::size_t>(j * kCorners + i)] +=
          height + slope_u * (i * kCell - kHalf) + slope_v * (j * kCell - kHalf);
}

double HeightMap::height(double u, double v) const {
  const double x = std::clamp((u + kHalf) / kCell, 0.0, kLast);
  const double y = std::clamp((v + kHalf) / kCell, 0.0, kLast);
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const double fu = x - i, fv = y - j;
  const double* c = &corner_[static_cast<std::size_t>(j * kCorners + i)];
  const double low = c[0] + fu * (c[1] - c[0]), high = c[kCorners] + fu * (c[kCorners + 1] - c[kCorners]);
  return low + fv * (high - low);
}

HeightMap::Slopes HeightMap::slopes(double u, double v) const {
  const double d = 0.5 * kCell;
  return {(height(u + d, v) - height(u - d, v)) / kCell, (height(u, v + d) - height(u, v - d)) / kCell};
}

HeightMap::Slopes HeightMap::mean_slopes(double u, double v, double radius) const {
  Slopes sum{0, 0};
  int count = 0;
  for (int j = 0; j < kNodes; ++j)
    for (int i = 0; i < kNodes; ++i) {
      const Node& n = node(i, j);
      const double du = node_at(i) - u, dv = node_at(j) - v;
      if (!n.covered || du * du + dv * dv > radius * radius) continue;
      sum.u += n.slope_u, sum.v += n.slope_v;
      ++count;
    }
  return count > 0 ? Slopes{sum.u / count, sum.v / count} : slopes(u, v);
}

bool HeightMap::covers(double u, double v) const {
  return nearest_node(u, v).covered && std::isfinite(height(u, v));
}

}  // namespace remote_touch
