#include "core/dissertation/depth/depth_processor.h"

#include <stdexcept>

namespace remote_touch {

namespace {

std::string wrong_window(const char* name, int window) {
  return window % 2 == 1
             ? ""
             : std::string(name) + " = " + std::to_string(window) + ": expected odd numbers, 3 to 15";
}

}  // namespace

Parameters parameters(DepthPipelineSettings& s) {
  return {
      {"filter", &s.filter, 0, 1, "filter the depth image spatially (7.1)"},
      {"filter_window", &s.filter_window, 3, 15,
       "width and height of the filter window of (7.1) in pixels; odd"},
      {"sigma_f_m", &s.sigma_f_m, 1e-4, 1,
       "sigma_f of the filter weights (7.2); depth steps smaller than a few sigma_f are smoothed"},
      {"normal_window", &s.normal_window, 3, 15,
       "width and height of the window of a normal in pixels, 6.2.1; odd"},
      {"normal_radius_m", &s.normal_radius_m, 1e-3, 1,
       "r_w of 6.2.1: neighbours at this distance or more have weight 0 (4.2) in a normal"},
      {"normal_step", &s.normal_step, 1, 7,
       "a normal, 6.2.1, uses only every normal_step-th column and row of its window, from the centre; "
       "must divide (normal_window - 1) / 2"},
      {"normal_fit", choice(s.normal_fit, {"total-least-squares", "inverse-depth"}), 0, 0,
       "fit of a normal, 6.2.1; inverse-depth is faster and has weights (1 - q^2)^2 in place of (4.2)"},
      {"sharp_edges", &s.sharp_edges, 0, 1,
       "true: a pixel near an edge may use the normal of a neighbouring window that fits it clearly better, 6.2.1; "
       "needs normal_fit = inverse-depth"},
  };
}

std::string validate(const DepthPipelineSettings& s) {
  const std::string filter = wrong_window("filter_window", s.filter_window);
  const std::string normal = wrong_window("normal_window", s.normal_window);
  if (!filter.empty() || !normal.empty()) return filter.empty() ? normal : filter;
  if (s.sharp_edges && s.normal_fit != NormalFit::inverse_depth)
    return "sharp_edges = true: expected normal_fit = inverse-depth";
  if (s.normal_window / 2 % s.normal_step == 0) return {};
  return "normal_step = " + std::to_string(s.normal_step) + ": expected a divisor of " +
         std::to_string(s.normal_window / 2) + " = (normal_window - 1) / 2";
}

DepthProcessor::DepthProcessor(const DepthPipelineSettings& settings) : settings_(settings) {
  const std::string wrong = validate(settings);
  if (!wrong.empty()) throw std::invalid_argument("DepthProcessor: " + wrong);
}

void check_sizes(const DepthImage& depth, const CameraIntrinsics& camera) {
  const std::size_t pixels = static_cast<std::size_t>(depth.width) * static_cast<std::size_t>(depth.height);
  if (depth.width != camera.width || depth.height != camera.height || depth.z_m.size() != pixels)
    throw std::invalid_argument("DepthProcessor: the depth image does not have the camera's size");
}

void become_image(PointCloud& cloud, const CameraIntrinsics& camera, const RigidTransform& X_WC) {
  const std::size_t count = camera.pixels();
  for (std::vector<double>* column : {&cloud.x, &cloud.y, &cloud.z}) column->resize(count);
  cloud.fixture_radius_m.clear(), cloud.stiffness_N_per_m.clear(), cloud.colour.clear();
  cloud.image = ImageLayout{camera, X_WC, 1e-6};  // same value as in cloud_from_depth
}

PointCloud DepthProcessor::process(const DepthImage& depth, const CameraIntrinsics& camera,
                                   const RigidTransform& X_WC) {
  PointCloud cloud;
  process(depth, camera, X_WC, cloud);
  return cloud;
}

void DepthProcessor::process(const DepthImage& depth, const CameraIntrinsics& camera,
                             const RigidTransform& X_WC, PointCloud& cloud) {
  check_sizes(depth, camera);
  become_image(cloud, camera, X_WC);
  process_frame({depth.z_m.data(), camera, X_WC}, cloud);
}

void DepthProcessor::process(PointCloud& cloud) {
  process_frame(frame_of(cloud), cloud);
}

DepthFrame DepthProcessor::frame_of(const PointCloud& cloud) {
  if (!cloud.image) throw std::invalid_argument("DepthProcessor: the cloud has no image layout");
  const ImageLayout& image = *cloud.image;
  const DepthFrame size{nullptr, image.camera, image.X_WC};
  if (cloud.size() != size.pixels())
    throw std::invalid_argument("DepthProcessor: the cloud does not have the camera's size");
  const RigidTransform X_CW = image.X_WC.inverse();
  depth_m_.resize(cloud.size());
  const auto count = static_cast<std::ptrdiff_t>(cloud.size());
#pragma omp parallel for schedule(static)
  for (std::ptrdiff_t i = 0; i < count; ++i)
    depth_m_[i] = X_CW.linear().row(2).dot(cloud.point(i)) + X_CW.translation().z();
  return {depth_m_.data(), image.camera, image.X_WC, !settings_.filter};
}

}  // namespace remote_touch
