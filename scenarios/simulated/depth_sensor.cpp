#include "scenarios/simulated/depth_camera.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/points/vector.h"

namespace remote_touch {
namespace {

// One row of the image. ahead[u] = d - u is the same all along a line towards the device: a surface that
// crosses the value of a point, to the right of the point, hides it from the device.
class ImageRow {
 public:
  ImageRow(const double* z_m, int width, double focal_baseline_px_m, double edge_jump_m)
      : z_m_(z_m), width_(width), edge_jump_m_(edge_jump_m) {
    const auto size = static_cast<std::size_t>(width);
    ahead_.resize(size), most_ahead_.resize(size + 1, -std::numeric_limits<double>::infinity());
    for (int u = width - 1; u >= 0; --u) {
      ahead_[u] =
          is_measured(u) ? focal_baseline_px_m / z_m[u] - u : -std::numeric_limits<double>::infinity();
      most_ahead_[u] = std::max(most_ahead_[u + 1], ahead_[u] + 0.5);
    }
  }

  bool is_in_shadow(int u) const {
    // No surface on the right is so near that the line to the device passes behind a part of it.
    if (!is_measured(u) || most_ahead_[u + 1] < ahead_[u]) return false;
    if (is_connected(u) && ahead_[u + 1] >= ahead_[u]) return true;  // it turns its back to the device
    for (int w = u + 1; w < width_ && most_ahead_[w] >= ahead_[u]; ++w)
      if (is_crossed_before(w, ahead_[u]) || is_crossed_after(w, ahead_[u])) return true;
    return false;
  }

 private:
  bool is_measured(int u) const { return z_m_[u] > 0; }  // false for NaN
  // True if the pixels u and u + 1 see the same surface.
  bool is_connected(int u) const { return u + 1 < width_ && std::abs(z_m_[u] - z_m_[u + 1]) <= edge_jump_m_; }
  // True if the surface of pixel w crosses the line in the half pixel before w, where it begins.
  bool is_crossed_before(int w, double line) const {
    return !is_connected(w - 1) && ahead_[w] <= line && line <= ahead_[w] + 0.5;
  }
  // True if the surface of pixel w crosses the line before pixel w + 1, or before its end behind w.
  bool is_crossed_after(int w, double line) const {
    const double here = ahead_[w], next = is_connected(w) ? ahead_[w + 1] : here - 0.5;
    return std::min(here, next) <= line && line <= std::max(here, next);
  }

  const double* z_m_;
  int width_;
  double edge_jump_m_;
  std::vector<double> ahead_;       // -infinity where nothing is measured
  std::vector<double> most_ahead_;  // largest value of this pixel and those to its right, with their borders
};

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

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// The sensors of depth_camera.h: baseline, focal length (0: that of the image), noise, step, window, lateral
// noise, range and angle.
constexpr Triangulation kStructuredLight{0.075, 580, 0.0625, 0.125, 1, 0.8, 108.75, 80};
constexpr Triangulation kActiveStereo{0.05, 0, 0.08, 1.0 / 32, 7, 0, 126, 80};

// Nguyen et al. 2012; lateral noise grows by this share of its value for a surface seen head-on.
constexpr double kAxialAtNearest_m = 0.0012, kAxialGrowth_per_m = 0.0019, kNearest_m = 0.4;
constexpr double kAxialGrazing = 0.0001, kLateralGrazing = 0.035 / 0.8;

// Returns theta / (pi / 2 - theta) for the angle theta between a ray and a normal.
double grazing(double cosine) {
  constexpr double kQuarterTurn = 1.5707963267948966;
  const double c = std::clamp(std::abs(cosine), 0.0, 1.0);
  const double angle = 0.5 * rotation_vector(Eigen::Quaterniond(c, std::sqrt(1 - c * c), 0, 0)).norm();
  return angle / (kQuarterTurn - angle);
}

// Returns the standard deviation of the disparity in px, before the rounding, which adds the rest of the
// published value. focal_baseline: in px m. q: grazing() of the angle.
double disparity_noise(const DepthSensorSettings& s, const Triangulation& t, double focal_baseline,
                       double z_m, double q) {
  if (t.noise_px == 0) return 0;
  double published_px = t.noise_px;
  if (s.sensor == DepthSensorKind::structured_light) {
    const double px_per_m = focal_baseline / (z_m * z_m), beyond_m = z_m - kNearest_m;
    if (s.axial_noise == AxialNoise::nguyen_2012)
      published_px = (kAxialAtNearest_m + kAxialGrowth_per_m * beyond_m * beyond_m) * px_per_m;
    published_px += kAxialGrazing / std::sqrt(z_m) * q * q * px_per_m;
  }
  return std::sqrt(std::max(0.0, published_px * published_px - t.step_px * t.step_px / 12));
}

}  // namespace

std::vector<char> baseline_shadow(const DepthImage& depth, double focal_baseline_px_m, double edge_jump_m) {
  std::vector<char> hidden(depth.z_m.size(), 0);
#pragma omp parallel for schedule(static)
  for (int v = 0; v < depth.height; ++v) {
    const std::size_t first = static_cast<std::size_t>(v) * static_cast<std::size_t>(depth.width);
    const ImageRow row(&depth.z_m[first], depth.width, focal_baseline_px_m, edge_jump_m);
    for (int u = 0; u < depth.width; ++u) hidden[first + static_cast<std::size_t>(u)] = row.is_in_shadow(u);
  }
  return hidden;
}

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

Parameters parameters(DepthSensorSettings& s) {
  const Parameters own = {
      {"sensor", choice(s.sensor, {"simple", "structured-light", "active-stereo"}), 0, 0,
       "model of the sensor's errors; simple: noise_per_m, quantisation_per_m and hole_px; structured-light: "
       "Kinect of 2010; active-stereo: RealSense D400; both measure disparities, f b / z in pixels"},
      {"max_depth_m", &s.max_depth_m, 0.01, 100, "largest depth that the sensor measures"},
      {"axial_noise", choice(s.axial_noise, {"disparity", "nguyen-2012"}), 0, 0,
       "structured-light: standard deviation of depth on a surface seen head-on, rounding included: from noise_px, "
       "or 1.2 mm + 1.9 mm (z / m - 0.4)^2"},
      {"baseline_m", &s.baseline_m, -1, 1,
       "distance of the projector or second camera, to the camera's right; below 0: that of the sensor, "
       "0.075 (structured-light) or 0.05 (active-stereo)"},
      {"disparity_focal_px", &s.disparity_focal_px, -1, 1e5,
       "focal length f of the camera that measures the disparity; 0: that of the image, focal_px; below 0: that of "
       "the sensor, 580 (structured-light) or focal_px (active-stereo)"},
      {"noise_px", &s.noise_px, -1, 10,
       "standard deviation of the disparity, that of the rounding included; 0: no noise; below 0: that of the "
       "sensor, 0.0625 or 0.08",
       kLive},
      {"disparity_step_px", &s.disparity_step_px, -1, 10,
       "disparity is rounded to multiples of this; 0: not rounded; below 0: that of the sensor, 1/8 or 1/32"},
      {"window_px", &s.window_px, -1, 64,
       "width of the matching window, over which noise is correlated; below 1: that of the sensor, 1 or 7"},
      {"lateral_noise_px", &s.lateral_noise_px, -1, 16,
       "standard deviation of the position of depth edges in the image; below 0: that of the sensor, 0.8 or "
       "0"},
      {"max_disparity_px", &s.max_disparity_px, -1, 4096,
       "nearer surfaces, of larger disparity, have no depth; below 0: that of the sensor, 108.75 or 126"},
      {"max_angle_deg", &s.max_angle_deg, -1, 90,
       "largest angle between ray and normal of a surface with a depth; below 0: that of the sensor, 80"},
  };
  return appended(parameters(s.camera), own);
}

std::string validate(const DepthSensorSettings& s) {
  if (s.baseline_m == 0) return "baseline_m = 0: expected above 0, or below 0 for that of the sensor";
  return validate(s.camera);
}

Triangulation triangulation(const DepthSensorSettings& s) {
  Triangulation t = s.sensor == DepthSensorKind::active_stereo ? kActiveStereo : kStructuredLight;
  const auto set = [](double& value, double setting) {
    if (setting >= 0) value = setting;
  };
  set(t.baseline_m, s.baseline_m), set(t.focal_px, s.disparity_focal_px), set(t.noise_px, s.noise_px);
  set(t.step_px, s.disparity_step_px);
  set(t.lateral_noise_px, s.lateral_noise_px), set(t.max_disparity_px, s.max_disparity_px);
  set(t.max_angle_deg, s.max_angle_deg);
  if (s.window_px >= 1) t.window_px = s.window_px;
  if (t.focal_px == 0) t.focal_px = s.camera.focal_px;
  return t;
}

DepthSensor::DepthSensor(const DepthSensorSettings& settings, const NoiseKey& key, const Kernels& kernels)
    : settings_(settings),
      key_(key),
      kernels_(kernels),
      camera_(settings.camera, key, kernels),
      triangulation_(triangulation(settings)),
      min_cosine_(sin_cos(kRadiansPerDegree * triangulation_.max_angle_deg).second) {}

bool DepthSensor::noisy() const {
  if (settings_.sensor == DepthSensorKind::simple) return camera_.noisy();
  return triangulation_.noise_px > 0 || triangulation_.lateral_noise_px > 0;
}

SceneView DepthSensor::view(DepthImage depth, const std::vector<double>& cosine,
                            std::vector<std::uint32_t> colour) const {
  const CameraIntrinsics& camera = intrinsics();
  if (depth.width != camera.width || depth.height != camera.height || depth.z_m.size() != camera.pixels() ||
      (!cosine.empty() && cosine.size() != camera.pixels()))
    throw std::invalid_argument("depth sensor: expected an image of " + size_text(camera));
  for (double& z : depth.z_m)
    if (!(z <= settings_.max_depth_m)) z = kNaN;
  if (settings_.sensor == DepthSensorKind::simple)
    return {camera_.view(std::move(depth), std::move(colour)), {}, {}};
  SceneView view{{std::move(depth), {}, std::move(colour), {}}, {}, {}};
  view.ideal.hole = baseline_shadow(view.ideal.depth, image_focal_baseline(), settings_.camera.edge_jump_m);
  add_noise(cosine, view);
  return view;
}

// Sets the noise of every pixel, and adds the holes that are no shadow.
void DepthSensor::add_noise(const std::vector<double>& cosine, SceneView& view) const {
  const int width = intrinsics().width, height = intrinsics().height;
  const bool is_lateral = triangulation_.lateral_noise_px > 0;
  const bool uses_angle = is_lateral || settings_.sensor == DepthSensorKind::structured_light;
  view.noise_px.assign(intrinsics().pixels(), 0);
  if (is_lateral) view.lateral_noise_px.assign(intrinsics().pixels(), triangulation_.lateral_noise_px);
#pragma omp parallel for schedule(static)
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * width + u;
      const double z = view.ideal.depth.z_m[i];
      if (std::isnan(z)) continue;
      const double c = cosine.empty() ? 1 : cosine[i], q = uses_angle && c < 1 ? grazing(c) : 0;
      view.noise_px[i] = disparity_noise(settings_, triangulation_, focal_baseline(), z, q);
      if (is_lateral) view.lateral_noise_px[i] *= 1 + kLateralGrazing * q;
      if (is_out_of_range(z, c, u)) view.ideal.hole[i] = 1;
    }
}

// Returns true if the sensor cannot measure the surface, although its second device may see it.
bool DepthSensor::is_out_of_range(double z_m, double cosine, int u) const {
  const bool is_beyond_second_image =
      settings_.sensor == DepthSensorKind::active_stereo && u < image_focal_baseline() / z_m;
  return focal_baseline() / z_m > triangulation_.max_disparity_px || std::abs(cosine) < min_cosine_ ||
         is_beyond_second_image;
}

// Returns the pixel whose surface pixel (u, v) measures: itself, or a displaced one that is on the other side
// of a depth edge.
std::size_t DepthSensor::source(const SceneView& view, int u, int v, double across, double down) const {
  const int width = intrinsics().width, height = intrinsics().height;
  const std::size_t own = static_cast<std::size_t>(v) * width + u;
  // The displacement may be infinite, and its sum with the pixel is limited before it becomes a whole number.
  const double sigma = view.lateral_noise_px[own];
  const double to_u = std::clamp(std::floor(u + sigma * across + 0.5), 0.0, width - 1.0);
  const double to_v = std::clamp(std::floor(v + sigma * down + 0.5), 0.0, height - 1.0);
  if (!(to_u >= 0 && to_v >= 0)) return own;  // NaN
  const std::size_t other =
      static_cast<std::size_t>(to_v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(to_u);
  const double z = view.ideal.depth.z_m[own], z_other = view.ideal.depth.z_m[other];
  const bool is_edge =
      std::isnan(z) != std::isnan(z_other) || std::abs(z - z_other) > settings_.camera.edge_jump_m;
  return is_edge ? other : own;
}

DepthImage DepthSensor::measured_depth(const SceneView& view, int frame) const {
  if (settings_.sensor == DepthSensorKind::simple) return camera_.measured_depth(view.ideal, frame);
  const int width = intrinsics().width, height = intrinsics().height;
  const bool is_lateral = !view.lateral_noise_px.empty();
  const NoiseStream stream = noise_stream(key_, NoiseUse::depth, static_cast<std::uint32_t>(frame));
  const WindowNoise noise =
      window_noise(width, height, triangulation_.window_px, is_lateral, stream, kernels_);
  DepthImage depth = view.ideal.depth;
  const double step = triangulation_.step_px;
#pragma omp parallel for schedule(static)
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * width + u;
      const std::size_t from = is_lateral ? source(view, u, v, noise.across[i], noise.down[i]) : i;
      double disparity = focal_baseline() / view.ideal.depth.z_m[from];
      disparity += view.noise_px[from] * noise.averaged[i];
      if (step > 0) disparity = step * std::floor(disparity / step + 0.5);
      const bool is_measured = !view.ideal.hole[from] && disparity > 0 && std::isfinite(disparity);
      depth.z_m[i] = is_measured ? focal_baseline() / disparity : kNaN;
    }
  return depth;
}

}  // namespace remote_touch
