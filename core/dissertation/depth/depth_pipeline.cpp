#include "core/dissertation/depth/depth_pipeline.h"

#include <algorithm>
#include <atomic>
#include <cmath>
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

namespace {

constexpr int kMaxHalf = 7;  // largest half width of a window, pixels
// Smallest number of rows in a band, if the frame has as many. One thread processes a band at a time. Each
// band computes the weights of the window above its first row again; this costs 3 % if bands have only 60
// rows.
constexpr int kBandRows = 60;

int half(int window) {
  return window / 2;
}

// Memory for the weights of the bands, in parts of equal size. No more parts are in use than there are
// threads, so those in use stay in the cache.
class ScratchPool {
 public:
  ScratchPool(float* first, std::size_t size, int count) : first_(first), size_(size), free_(all(count)) {}
  float* take() {
    std::uint64_t free = free_.load();
    while (!free_.compare_exchange_weak(free, free & (free - 1))) {
    }
    return first_ + size_ * static_cast<std::size_t>(__builtin_ctzll(free));
  }
  void give_back(const float* scratch) {
    free_.fetch_or(std::uint64_t{1} << static_cast<std::size_t>(scratch - first_) / size_);
  }

 private:
  static std::uint64_t all(int count) { return ~std::uint64_t{0} >> (64 - count); }
  float* first_;
  std::size_t size_;
  std::atomic<std::uint64_t> free_;
};

int band_count(int rows) {
  return std::clamp(rows / kBandRows, 1, 64);
}

}  // namespace

// The work for one call: a rectangle of an image, and the camera that saw it.
struct DepthPipeline::Frame {
  const double* depth_m;
  CameraIntrinsics camera;
  PixelRectangle at;
  double X_WC[12];
  bool has_points;
  int normal_half = 0, filter_half = 0;       // 0: no filter
  int shift = 0;                              // distance of the windows beside a pixel; 0: none
  double filter_scale = 1, normal_scale = 1;  // units of a plane per metre

  // Distance in pixels from the rectangle up to which filtered points (wider) and measured points (reach) are
  // needed.
  int wider() const { return shift + normal_half; }
  int reach() const { return wider() + filter_half; }
  // Limits of the rectangle after widening it by `wider` pixels, clipped to the image and counted from the
  // rectangle.
  int first_row(int wider) const { return std::max(-wider, -at.top); }
  int last_row(int wider) const { return std::min(at.height + wider, camera.height - at.top); }
  int first_column(int wider) const { return std::max(-wider, -at.left); }
  int last_column(int wider) const { return std::min(at.width + wider, camera.width - at.left); }
  const double* depth(int row, int column) const {
    return depth_m + static_cast<std::ptrdiff_t>(at.top + row) * camera.width + at.left + column;
  }
};

namespace {

bool fits(int first, int count, int all) {
  return first >= 0 && count >= 0 && first <= all - count;
}

}  // namespace

// The border is the widest region that the kernels touch around the requested pixels. It is wider with
// sharp_edges, because normals are also computed beside these pixels.
DepthPipeline::DepthPipeline(const DepthPipelineSettings& settings, const Kernels& kernels)
    : DepthProcessor(settings), kernels_(kernels), border_((settings.sharp_edges ? 5 : 3) * kMaxHalf) {}

DepthPipeline::Frame DepthPipeline::frame_of(const double* depth_m, const CameraIntrinsics& camera,
                                             const PixelRectangle& at, const RigidTransform& X_WC) const {
  Frame frame{depth_m, camera, at, {}, false};
  for (int i = 0; i < 12; ++i) frame.X_WC[i] = X_WC.matrix()(i / 4, i % 4);
  frame.normal_half = half(settings_.normal_window);
  frame.filter_half = settings_.filter ? half(settings_.filter_window) : 0;
  frame.shift = settings_.sharp_edges ? frame.normal_half + frame.filter_half : 0;
  frame.filter_scale = std::sqrt(kFilterExponent / 2) / settings_.sigma_f_m;
  frame.normal_scale = 1 / settings_.normal_radius_m;
  return frame;
}

void DepthPipeline::process(const DepthImage& depth, const CameraIntrinsics& camera,
                            const RigidTransform& X_WC, const PixelRectangle& at, PointCloud& cloud) {
  check_sizes(depth, camera);
  if (!fits(at.left, at.width, depth.width) || !fits(at.top, at.height, depth.height))
    throw std::invalid_argument("DepthPipeline: the rectangle is not in the image");
  CameraIntrinsics own = camera;
  own.width = at.width, own.height = at.height, own.cx -= at.left, own.cy -= at.top;
  become_image(cloud, own, X_WC);
  run(frame_of(depth.z_m.data(), camera, at, X_WC), cloud);
}

void DepthPipeline::process_frame(const DepthFrame& whole, PointCloud& cloud) {
  Frame frame =
      frame_of(whole.depth_m, whole.camera, {0, 0, whole.camera.width, whole.camera.height}, whole.X_WC);
  frame.has_points = whole.has_points;
  run(frame, cloud);
}

// Returns pointers to row 0 and the given column in each of three planes (x, y, z) that are stored one after
// another.
PointPlanes DepthPipeline::planes(std::vector<float>& values, int column) const {
  float* const first = values.data() + first_pixel() + column;
  return {first, first + plane_size_, first + 2 * plane_size_, stride_};
}

// Returns the same pointers into the planes of the fits; null pointers unless sharp_edges is set.
FitPlanes DepthPipeline::fit_planes(int column) {
  if (!settings_.sharp_edges) return {};
  float* const first = fits_.data() + first_pixel() + column;
  return {first, first + plane_size_, first + 2 * plane_size_, first + 3 * plane_size_};
}

void DepthPipeline::prepare(const Frame& frame) {
  const PixelRectangle& at = frame.at;
  stride_ = (at.width + 2 * border_ + 3 * kMaxLanes - 1) / kMaxLanes * kMaxLanes;
  plane_size_ = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(at.height + 2 * border_);
  const auto grow = [](auto& values, std::size_t size) {
    if (values.size() < size) values.resize(size);
  };
  for (std::vector<float>* each : {&raw_, &smooth_, &normals_}) grow(*each, 3 * plane_size_);
  grow(change_, plane_size_);
  if (settings_.sharp_edges) grow(fits_, 4 * plane_size_);
  const int pool = band_count(at.height + 2 * frame.wider());
  grow(scratch_,
       static_cast<std::size_t>(pool) *
           weight_buffer_size(at.width + 2 * frame.wider(), std::max(frame.normal_half, frame.filter_half)));
  valid_.resize(static_cast<std::size_t>(at.width) * static_cast<std::size_t>(at.height));
  const auto rays = [&](std::vector<double>& wide, std::vector<float>& narrow, std::size_t count, int first,
                        double centre, double focal) {
    grow(wide, count), grow(narrow, count);
    for (std::size_t i = 0; i < count; ++i) {
      wide[i] = (first + static_cast<int>(i) - border_ - centre) / focal;
      narrow[i] = static_cast<float>(wide[i]);
    }
  };
  rays(wide_rays_x_, rays_x_, static_cast<std::size_t>(stride_), at.left, frame.camera.cx, frame.camera.fx);
  rays(wide_rays_y_, rays_y_, static_cast<std::size_t>(at.height + 2 * border_), at.top, frame.camera.cy,
       frame.camera.fy);
}

// Removes the points of a row except those in columns first .. last - 1, which the caller writes.
void DepthPipeline::clear_beside(const PointPlanes& to, const Frame& frame, int row, int reach, int first,
                                 int last) const {
  for (float* plane : {to.x, to.y, to.z}) {
    float* const start = plane + row * stride_;
    std::fill(start - reach, start + first, kNowhere);
    std::fill(start + last, start + frame.at.width + reach, kNowhere);
  }
}

// Writes one row of points, either with the filter's changes or as measured. A pixel outside the image has no
// point.
void DepthPipeline::write_points(const Frame& frame, int row, int reach, double scale, bool changed,
                                 const PointPlanes& to) {
  const bool inside = row >= frame.first_row(reach) && row < frame.last_row(reach);
  const int end = frame.at.width + reach;
  const int first = inside ? frame.first_column(reach) : end, last = inside ? frame.last_column(reach) : end;
  clear_beside(to, frame, row, reach, first, last);
  if (!inside) return;
  const std::ptrdiff_t at = row * stride_ + first;
  kernels_.depth.depth_to_points(pixels(frame, row, first, last, changed), scale,
                                 {to.x + at, to.y + at, to.z + at, stride_});
}

PixelRow DepthPipeline::pixels(const Frame& frame, int row, int first, int last, bool changed) const {
  const float* const change = change_.data() + first_pixel() + row * stride_ + first;
  return {last - first,
          wide_rays_x_.data() + border_ + first,
          wide_rays_y_[static_cast<std::size_t>(border_ + row)],
          frame.depth(row, first),
          changed ? change : nullptr,
          1 / frame.filter_scale};
}

void DepthPipeline::filter_band(const Frame& frame, int first, int last, float* scratch) {
  const int wider = frame.wider(), width = frame.at.width + 2 * wider;
  float* const change = change_.data() + first_pixel() - wider;
  kernels_.depth.filter_depth({first, last, width, frame.filter_half, scratch}, planes(raw_, -wider), change);
  const PointPlanes smooth = planes(smooth_, 0);
  for (int row = first; row < last; ++row) write_points(frame, row, wider, frame.normal_scale, true, smooth);
}

// Computes normals of the rectangle and, with sharp_edges, of pixels beside it.
void DepthPipeline::normals_band(const Frame& frame, int first, int last, float* scratch) {
  const int beside = frame.shift;
  const PixelRays rays{rays_x_.data() + border_ - beside, rays_y_.data() + border_};
  const float step[2] = {static_cast<float>(1 / frame.camera.fx), static_cast<float>(1 / frame.camera.fy)};
  const PointPlanes points = planes(smooth_, -beside), normals = planes(normals_, -beside);
  const RowBand band{
      first, last, frame.at.width + 2 * beside, frame.normal_half, scratch, settings_.normal_step};
  if (settings_.normal_fit == NormalFit::total_least_squares)
    kernels_.depth.plane_normals(band, points, rays, step, normals);
  else
    kernels_.depth.inverse_depth_normals(band, points, rays, step, normals, fit_planes(-beside));
}

// Writes one row of the cloud. normals: pointers to column 0 of row 0.
void DepthPipeline::row_to_cloud(const Frame& frame, int row, const PointPlanes& normals, PointCloud& cloud) {
  const int width = frame.at.width;
  const std::size_t to = static_cast<std::size_t>(row) * static_cast<std::size_t>(width);
  const std::ptrdiff_t at = row * stride_;
  const CloudRow out{cloud.x.data() + to,  cloud.y.data() + to,  cloud.z.data() + to, cloud.nx.data() + to,
                     cloud.ny.data() + to, cloud.nz.data() + to, valid_.data() + to};
  const float* const z = planes(smooth_, 0).z + at;
  PointPlanes of_row{normals.x + at, normals.y + at, normals.z + at, stride_};
  if (frame.shift > 0) {
    const PointPlanes sharp = planes(raw_, 0);  // the measured points are not needed any more
    const PointPlanes sharp_row{sharp.x + at, sharp.y + at, sharp.z + at, stride_};
    const FitPlanes fits = fit_planes(0);
    kernels_.depth.sharp_normals(width, frame.shift, z, of_row,
                                 {fits.a + at, fits.b + at, fits.c + at, fits.error + at}, sharp_row);
    of_row = sharp_row;
  }
  if (!frame.has_points)
    kernels_.depth.points_to_cloud(pixels(frame, row, 0, width, settings_.filter), frame.X_WC, out);
  kernels_.depth.normals_to_cloud(width, z, of_row, frame.X_WC, out);
}

void DepthPipeline::run(const Frame& frame, PointCloud& cloud) {
  prepare(frame);
  for (std::vector<double>* column : {&cloud.nx, &cloud.ny, &cloud.nz}) column->resize(cloud.size());
  const int reach = frame.reach(), wider = frame.wider(), height = frame.at.height;
  const PointPlanes first_planes = planes(settings_.filter ? raw_ : smooth_, 0);
  const double scale = settings_.filter ? frame.filter_scale : frame.normal_scale;
#pragma omp parallel for schedule(static)
  for (int row = -reach; row < height + reach; ++row)
    write_points(frame, row, reach, scale, false, first_planes);

  // Processes rows first .. last - 1 in bands. Each band writes only its own rows.
  const auto in_bands = [&](int first, int last, int half_window, const auto& work) {
    const int bands = band_count(last - first);
    const std::size_t size = weight_buffer_size(frame.at.width + 2 * wider, half_window);
    ScratchPool pool(scratch_.data(), size, bands);
#pragma omp parallel for schedule(static)
    for (int band = 0; band < bands; ++band) {
      float* const scratch = pool.take();
      work(first + (last - first) * band / bands, first + (last - first) * (band + 1) / bands, scratch);
      pool.give_back(scratch);
    }
  };
  if (settings_.filter) {
    const PointPlanes smooth = planes(smooth_, 0);
    for (int row = -wider; row < height + wider; ++row)
      if (row < frame.first_row(wider) || row >= frame.last_row(wider))
        write_points(frame, row, wider, 0, false, smooth);
    in_bands(frame.first_row(wider), frame.last_row(wider), frame.filter_half,
             [&](int first, int last, float* scratch) { filter_band(frame, first, last, scratch); });
  }
  const PointPlanes normals = planes(normals_, 0);
  const auto to_cloud = [&](int row) { row_to_cloud(frame, row, normals, cloud); };
  const int beside = frame.shift;
  in_bands(-beside, height + beside, frame.normal_half, [&](int first, int last, float* scratch) {
    normals_band(frame, first, last, scratch);
    for (int row = first; beside == 0 && row < last; ++row) to_cloud(row);
  });
  if (beside == 0) return;
#pragma omp parallel for schedule(static)
  for (int row = 0; row < height; ++row) to_cloud(row);
}

}  // namespace remote_touch
