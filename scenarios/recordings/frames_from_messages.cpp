#include "scenarios/recordings/frames_from_messages.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <string_view>

#include "core/points/point_cloud.h"
#include "scenarios/files/depth_images.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

// Returns z_m, or NaN if it is not above 0, above max_depth_m, or not finite.
double measured_or_nan(double z_m, double max_depth_m) {
  const bool measured = z_m > 0 && z_m <= max_depth_m && z_m <= std::numeric_limits<double>::max();
  return measured ? z_m : std::numeric_limits<double>::quiet_NaN();
}

template <class Value>
DepthImage depth_of_rows(const ImageMessage& message, double scale, double max_depth_m,
                         const std::string& subject) {
  const std::uint64_t width = message.width, height = message.height, row = width * sizeof(Value);
  if (width * height == 0 || width * height > kMaxImagePixels)
    refuse(subject, "has ", width, " x ", height, " pixels: expected 1 to ", kMaxImagePixels);
  if (message.step < row)
    refuse(subject, "step = ", message.step, ": expected ", row, " or more, a row of pixels");
  const std::uint64_t needed = (height - 1) * message.step + row;
  if (message.data.size() < needed)
    refuse(subject, "has ", message.data.size(), " bytes of data: expected ", needed,
           " or more, as its height and step say");
  DepthImage depth{static_cast<int>(width), static_cast<int>(height), std::vector<double>(width * height)};
  for (std::uint64_t i = 0; i < width * height; ++i) {
    const char* at = message.data.data() + i / width * message.step + i % width * sizeof(Value);
    depth.z_m[i] = measured_or_nan(number_at<Value>(at, message.big_endian) * scale, max_depth_m);
  }
  return depth;
}

// Lens model: maps the ray (x, y, 1) of a pinhole to the ray that the lens makes of it. D = (k1, k2, p1, p2,
// k3).
struct PlumbBob {
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;

  explicit PlumbBob(const std::vector<double>& d)
      : k1(d[0]), k2(d[1]), p1(d[2]), p2(d[3]), k3(d.size() > 4 ? d[4] : 0) {}

  Eigen::Vector2d bent(const Eigen::Vector2d& ray) const {
    const double x = ray.x(), y = ray.y(), r2 = x * x + y * y;
    const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
            y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
  }

  Eigen::Matrix2d slope(const Eigen::Vector2d& ray) const {
    const double x = ray.x(), y = ray.y(), r2 = x * x + y * y;
    const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const double grows = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3));  // d radial / d r2, times 2
    Eigen::Matrix2d J;
    J(0, 0) = radial + x * x * grows + 2 * p1 * y + 6 * p2 * x;
    J(0, 1) = J(1, 0) = x * y * grows + 2 * p1 * x + 2 * p2 * y;
    J(1, 1) = radial + y * y * grows + 6 * p1 * y + 2 * p2 * x;
    return J;
  }

  // Far from the centre the polynomial may fold the image over, which no real lens does.
  bool is_one_to_one_at(const Eigen::Vector2d& ray) const {
    const Eigen::Matrix2d J = slope(ray);
    return J.determinant() > 0 && J.trace() > 0;
  }

  // Computes the ray that the lens bends to `to`, by Newton's method from a guess that is within about a
  // pixel. Returns false if there is none.
  bool unbend(const Eigen::Vector2d& to, Eigen::Vector2d& ray) const {
    constexpr double kExact = 1e-13;
    for (int i = 0; i < 20; ++i) {
      if (!is_one_to_one_at(ray)) return false;
      const Eigen::Vector2d change = slope(ray).inverse() * (to - bent(ray));
      ray += change;
      if (!(change.norm() > kExact)) return ray.allFinite();
    }
    return false;
  }
};

// Returns true if a lens of this model is a pinhole when all its coefficients are 0 or missing. A fisheye is
// not. RealSense writes the names with capitals.
bool bends_by_coefficients_only(const std::string& model) {
  static const std::array<std::string_view, 9> kModels = {"",
                                                          "none",
                                                          "None",
                                                          "pinhole",
                                                          "plumb_bob",
                                                          "rational_polynomial",
                                                          "Brown Conrady",
                                                          "Inverse Brown Conrady",
                                                          "Modified Brown Conrady"};
  return std::find(kModels.begin(), kModels.end(), model) != kModels.end();
}

// A stored binning of 0 means 1.
std::uint32_t binning(std::uint32_t stored) {
  return std::max<std::uint32_t>(1, stored);
}

// The pixels of the sensor that the image shows, along one axis. A region without a size is the whole sensor,
// if it has no offset.
struct Extent {
  std::uint32_t offset = 0, size = 0;
};
Extent extent(std::uint32_t sensor, Extent region, const std::string& axis, const std::string& subject) {
  if (region.offset == 0 && region.size == 0) return {0, sensor};
  const std::uint64_t end = std::uint64_t{region.offset} + region.size;
  if (region.size == 0 || end > sensor)
    refuse(subject, "roi has pixels ", region.offset, " to ", end, " along ", axis, ": expected some of the ",
           sensor, " that the camera has, or roi all 0");
  return region;
}
Extent extent_x(const CameraInfoMessage& info, const std::string& subject) {
  return extent(info.width, {info.region.x_offset, info.region.width}, "x", subject);
}
Extent extent_y(const CameraInfoMessage& info, const std::string& subject) {
  return extent(info.height, {info.region.y_offset, info.region.height}, "y", subject);
}

// Focal length and centre along one axis.
struct Axis {
  double f = 0, c = 0;
};
Axis binned(const Axis& sensor, std::uint32_t offset, std::uint32_t pixels) {
  const double b = pixels;
  return {sensor.f / b, (sensor.c - offset - 0.5 * (b - 1)) / b};
}

// Throws InputError unless the matrix is (fx 0 cx; 0 fy cy; 0 0 1), for P with a fourth column of 0. Some
// drivers write 0 for the 1, which is accepted.
void require_pinhole(const double* matrix, std::size_t columns, const char* name,
                     const std::string& subject) {
  for (std::size_t i = 0; i < 3 * columns; ++i) {
    const std::size_t row = i / columns, column = i % columns;
    if (column == row ? row < 2 : column == 2) continue;  // fx, fy, cx, cy
    const double expected = row == 2 && column == 2 ? 1 : 0;
    if (matrix[i] == expected || (expected == 1 && matrix[i] == 0)) continue;
    refuse(subject, name, "[", i, "] = ", matrix[i], ": expected ", (expected == 1 ? "1" : "0"),
           (column == 3 ? ", the camera of the image itself and not the second of a pair"
            : row < 2   ? ", a camera without skew"
                        : ""));
  }
}

static_assert(std::endian::native == std::endian::little, "a message may be the other way round");

constexpr std::uint64_t kMaxPoints = 1u << 24;  // 0.4 GB of coordinates
constexpr std::uint8_t kInt32 = 5, kFloat32 = 7, kFloat64 = 8;

const PointField* field_named(const PointCloudMessage& message, const std::string& name) {
  const auto found = std::find_if(message.fields.begin(), message.fields.end(),
                                  [&](const PointField& field) { return field.name == name; });
  return found == message.fields.end() ? nullptr : &*found;
}

void check_place(const PointField& field, std::uint64_t size, const PointCloudMessage& message,
                 const std::string& subject) {
  if (field.offset + size <= message.point_step) return;
  refuse(subject, "field ", field.name, " ends at byte ", field.offset + size,
         ": expected at most point_step = ", message.point_step);
}

// Throws InputError if a field has several values a point. Some programs write 0 for a single value.
void check_count(const PointField& field, const std::string& subject) {
  if (field.count <= 1) return;
  refuse(subject, "field ", field.name, " has ", field.count, " values a point: expected 1");
}

const PointField& coordinate(const PointCloudMessage& message, const std::string& name,
                             const std::string& subject) {
  const PointField* field = field_named(message, name);
  if (!field) refuse(subject, "has no field ", name, ": expected x, y and z");
  if (field->datatype != kFloat32 && field->datatype != kFloat64)
    refuse(subject, "field ", name, " has datatype ", field->datatype,
           ": expected 7 (float32) or 8 (float64)");
  check_place(*field, field->datatype == kFloat64 ? 8 : 4, message, subject);
  check_count(*field, subject);
  return *field;
}

// Throws InputError if the data cannot hold what the message claims. The products of 32-bit numbers fit in 64
// bits.
void check_size(const PointCloudMessage& message, const std::string& subject) {
  const std::uint64_t width = message.width, height = message.height;
  if (width * height > kMaxPoints)
    refuse(subject, "claims ", width, " x ", height, " points: expected up to ", kMaxPoints);
  if (width * height == 0) return;
  const std::uint64_t row = width * message.point_step;
  if (height > 1 && message.row_step < row)
    refuse(subject, "row_step = ", message.row_step, ": expected ", row, " or more, a row of points");
  const std::uint64_t needed = (height - 1) * message.row_step + row;
  if (message.data.size() < needed)
    refuse(subject, "has ", message.data.size(), " bytes of data: expected ", needed,
           " or more, as its width, height and steps say");
}

template <class Value, class Column>
void read_column(const PointCloudMessage& message, const PointField& field, Column& column) {
  column.resize(std::size_t{message.width} * message.height);
  auto* out = column.data();
  for (std::size_t v = 0; v < message.height; ++v) {
    const char* at = message.data.data() + v * message.row_step + field.offset;
    for (std::size_t u = 0; u < message.width; ++u, at += message.point_step)
      *out++ = number_at<Value>(at, message.big_endian);
  }
}

void read_coordinate(const PointCloudMessage& message, const std::string& name, const std::string& subject,
                     std::vector<double>& column) {
  const PointField& field = coordinate(message, name, subject);
  if (field.datatype == kFloat64) {
    read_column<double>(message, field, column);
  } else {
    read_column<float>(message, field, column);
  }
}

// PCL stores the bits of the colour as a float, other programs store them as an integer.
void read_colour(const PointCloudMessage& message, const std::string& subject,
                 std::vector<std::uint32_t>& colour) {
  const PointField* field = field_named(message, "rgb");
  if (!field) field = field_named(message, "rgba");
  if (!field) return;
  if (field->datatype < kInt32 || field->datatype > kFloat32)
    refuse(subject, "field ", field->name, " has datatype ", field->datatype,
           ": expected 5 (int32), 6 (uint32) or 7 (float32)");
  check_place(*field, 4, message, subject);
  check_count(*field, subject);
  read_column<std::uint32_t>(message, *field, colour);
  for (std::uint32_t& c : colour) c = field->datatype == kFloat32 ? colour_of_float(c) : c & 0xFFFFFF;
}

}  // namespace

bool is_depth_encoding(const std::string& encoding) {
  return encoding == "16UC1" || encoding == "mono16" || encoding == "Z16" || encoding == "32FC1";
}

DepthImage depth_from_message(const ImageMessage& message, const DepthUnits& units, double max_depth_m,
                              const std::string& subject) {
  const std::string& encoding = message.encoding;
  if (!is_depth_encoding(encoding))
    refuse(subject, "encoding = \"", encoding.substr(0, 32), "\": expected depths as ", kDepthEncodings);
  if (encoding == "32FC1") return depth_of_rows<float>(message, units.of_floats_m, max_depth_m, subject);
  return depth_of_rows<std::uint16_t>(message, units.of_integers_m, max_depth_m, subject);
}

DepthImage depth_from_message(const CompressedImageMessage& message, const DepthUnits& units,
                              double max_depth_m, const std::string& subject) {
  constexpr std::size_t kHeader = 12;
  const bool integers = message.format.starts_with("16UC1"), floats = message.format.starts_with("32FC1");
  const bool transport = message.format.find("compressedDepth") != std::string::npos;
  if (!transport || !(integers || floats) || message.format.find("rvl") != std::string::npos)
    refuse(subject, "format = \"", message.format.substr(0, 64),
           "\": expected \"16UC1; compressedDepth\" or \"32FC1; compressedDepth\", "
           "with PNG inside");
  if (message.data.size() < kHeader)
    refuse(subject, "has ", message.data.size(),
           " bytes of data: expected a header of 12 bytes and a PNG image");
  const float a = number_at<float>(message.data.data() + 4), b = number_at<float>(message.data.data() + 8);
  const GreyImage image = decode_grey_png(message.data.substr(kHeader), subject);
  DepthImage depth{image.width, image.height, std::vector<double>(image.values.size())};
  for (std::size_t i = 0; i < depth.z_m.size(); ++i) {
    const double q = image.values[i];
    const double z_m = integers ? q * units.of_integers_m : q > 0 ? a / (q - b) * units.of_floats_m : 0;
    depth.z_m[i] = measured_or_nan(z_m, max_depth_m);
  }
  return depth;
}

ImageSize image_size(const CameraInfoMessage& info, const std::string& subject) {
  const std::uint32_t bx = binning(info.binning_x), by = binning(info.binning_y);
  const ImageSize size = {extent_x(info, subject).size / bx, extent_y(info, subject).size / by};
  if (info.width > 0 && info.height > 0 && (size.width == 0 || size.height == 0))
    refuse(subject, "binning = ", bx, " x ", by, ": expected no more than the pixels that the camera has");
  return size;
}

ImageRays::ImageRays(const CameraInfoMessage& info, bool rectified, const std::string& subject) {
  const ImageSize size = image_size(info, subject);
  const std::uint64_t pixels = std::uint64_t{size.width} * size.height;
  if (pixels == 0 || pixels > kMaxImagePixels)
    refuse(subject, "has ", size.width, " x ", size.height, " pixels: expected 1 to ", kMaxImagePixels);
  const auto& K = info.K;
  const auto& P = info.P;
  const double fx = rectified ? P[0] : K[0], fy = rectified ? P[5] : K[4];
  const double cx = rectified ? P[2] : K[2], cy = rectified ? P[6] : K[5];
  const auto sound = [](double f) { return f > 1e-6 && f < 1e6; };  // so that every ray is finite
  const Axis x = binned({fx, cx}, info.region.x_offset, binning(info.binning_x));
  const Axis y = binned({fy, cy}, info.region.y_offset, binning(info.binning_y));
  if (!sound(x.f) || !sound(y.f) || !(std::abs(x.c) < 1e6) || !(std::abs(y.c) < 1e6))
    refuse(subject, rectified ? "P" : "K", " has fx = ", fx, ", fy = ", fy, ", cx = ", cx, ", cy = ", cy,
           ": expected a calibrated camera");
  if (rectified)
    require_pinhole(P.data(), 4, "P", subject);
  else
    require_pinhole(K.data(), 3, "K", subject);
  if (rectified && info.region.do_rectify)
    refuse(subject,
           "roi.do_rectify = true: expected false, because the region of the rectified image "
           "is not stated");
  camera_ = {static_cast<int>(size.width), static_cast<int>(size.height), x.f, y.f, x.c, y.c};
  const auto& d = info.distortion;
  if (rectified) return;
  const bool straight = std::all_of(d.begin(), d.end(), [](double k) { return k == 0; });
  if (straight && bends_by_coefficients_only(info.distortion_model)) return;
  const bool finite = std::all_of(d.begin(), d.end(), [](double k) { return std::isfinite(k); });
  if (info.distortion_model != "plumb_bob" || (d.size() != 4 && d.size() != 5) || !finite)
    refuse(subject, "distortion_model = \"", info.distortion_model.substr(0, 32), "\" with ", d.size(),
           " coefficients: expected plumb_bob with 4 or 5 finite ones, or a pinhole");
  make_table(info);
}

void ImageRays::make_table(const CameraInfoMessage& info) {
  const PlumbBob lens(info.distortion);
  const std::size_t pixels = static_cast<std::size_t>(camera_.width) * camera_.height;
  source_.assign(pixels, -1), ray_x_.assign(pixels, 0), ray_y_.assign(pixels, 0);
  const auto pixel = [&](const Eigen::Vector2d& ray) {
    return Eigen::Vector2d(camera_.fx * ray.x() + camera_.cx, camera_.fy * ray.y() + camera_.cy);
  };
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::size_t u = i % static_cast<std::size_t>(camera_.width);
    const std::size_t v = i / static_cast<std::size_t>(camera_.width);
    const Eigen::Vector2d at(static_cast<double>(u), static_cast<double>(v));
    Eigen::Vector2d ray((at.x() - camera_.cx) / camera_.fx, (at.y() - camera_.cy) / camera_.fy);
    if (!lens.is_one_to_one_at(ray)) continue;
    const Eigen::Vector2d seen = pixel(lens.bent(ray)).array().round();
    if (!(seen.x() >= 0 && seen.y() >= 0 && seen.x() < camera_.width && seen.y() < camera_.height)) continue;
    const Eigen::Vector2d to((seen.x() - camera_.cx) / camera_.fx, (seen.y() - camera_.cy) / camera_.fy);
    constexpr double kMaxSlack_px = 2;  // beyond it the lens shrinks the image too much for one point a pixel
    if (!lens.unbend(to, ray) || !((pixel(ray) - at).cwiseAbs().maxCoeff() < kMaxSlack_px)) continue;
    slack_ = std::max(slack_, (pixel(ray) - at).cwiseAbs().maxCoeff() + 1e-6);
    source_[i] = static_cast<int>(seen.y()) * camera_.width + static_cast<int>(seen.x());
    ray_x_[i] = ray.x(), ray_y_[i] = ray.y();
  }
}

PointCloud ImageRays::cloud(const DepthImage& depth) const {
  assert(depth.width == camera_.width && depth.height == camera_.height);
  if (!has_distortion()) return cloud_from_depth(depth, camera_, RigidTransform::Identity());
  PointCloud cloud;
  const std::size_t pixels = source_.size();
  cloud.x.resize(pixels), cloud.y.resize(pixels), cloud.z.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const double z_m = source_[i] < 0 ? std::numeric_limits<double>::quiet_NaN()
                                      : depth.z_m[static_cast<std::size_t>(source_[i])];
    cloud.x[i] = ray_x_[i] * z_m, cloud.y[i] = ray_y_[i] * z_m, cloud.z[i] = z_m;
  }
  cloud.image = ImageLayout{camera_, RigidTransform::Identity(), slack_};
  return cloud;
}

PointCloud cloud_from_message(const PointCloudMessage& message, const std::string& subject) {
  check_size(message, subject);
  PointCloud cloud;
  if (message.width == 0) return cloud;  // an empty cloud may have any number of rows
  read_coordinate(message, "x", subject, cloud.x);
  read_coordinate(message, "y", subject, cloud.y);
  read_coordinate(message, "z", subject, cloud.z);
  read_colour(message, subject, cloud.colour);
  mark_missing_points(cloud);
  if (message.height > 1) {
    cloud.grid_columns = static_cast<int>(message.width);
    cloud.image = fit_pinhole(cloud, cloud.grid_columns, static_cast<int>(message.height));
  }
  return cloud;
}

}  // namespace remote_touch
