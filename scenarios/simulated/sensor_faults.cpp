#include "scenarios/simulated/sensor_faults.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/parameters/parameter.h"

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
  assert(noise.memory >= 0 && noise.memory < 1);
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

namespace {

// Indices into the random numbers of a point and of a frame.
enum PointDraw { drops = 0, is_outlier = 1, flies = 2, how_far = 3 };
enum FrameDraw { repeats = 0, is_late = 1 };

NoiseStream of_points(const NoiseKey& key, int frame) {
  return noise_stream(key, NoiseUse::sensor_point, static_cast<std::uint32_t>(frame));
}
NoiseStream of_frame(const NoiseKey& key, int frame) {
  return noise_stream(key, NoiseUse::sensor_frame, static_cast<std::uint32_t>(frame));
}

// A fault draws random numbers, moves points along the view, loses points or shears them.
enum Effect : unsigned { draws = 1, moves = 2, loses = 4, shears = 8 };

// Each fault: its parameter, its size, which is 0 without it, and what it does.
constexpr struct {
  const char* parameter;
  double (*size)(const SensorFaults& s);
  unsigned effects;
} kFaults[] = {
    {"repeat_probability", [](const SensorFaults& s) { return s.repeat_probability; }, draws},
    {"rolling_shutter_s", [](const SensorFaults& s) { return s.rolling_shutter_s; }, shears},
    {"ray_noise_m", [](const SensorFaults& s) { return s.ray_noise.sigma_m; }, draws | moves},
    {"flying_probability", [](const SensorFaults& s) { return s.flying_probability; }, draws | moves},
    {"outlier_probability", [](const SensorFaults& s) { return s.outlier_probability; }, draws | moves},
    {"quantisation_m", [](const SensorFaults& s) { return s.quantisation_m; }, moves},
    {"hole_fraction", [](const SensorFaults& s) { return s.hole_fraction; }, draws | loses},
    {"dropout_probability", [](const SensorFaults& s) { return s.dropout_probability; }, draws | loses},
    {"late_probability", [](const SensorFaults& s) { return s.late_probability; }, draws},
};

// Returns true if one of the faults has one of these effects.
bool have(const SensorFaults& s, unsigned effects) {
  return std::any_of(std::begin(kFaults), std::end(kFaults),
                     [&](const auto& fault) { return (fault.effects & effects) != 0 && fault.size(s) > 0; });
}

void lose(PointCloud& cloud, std::size_t i) {
  cloud.x[i] = cloud.y[i] = cloud.z[i] = std::numeric_limits<double>::quiet_NaN();
  if (cloud.has_normals()) cloud.nx[i] = cloud.ny[i] = cloud.nz[i] = cloud.x[i];
}

void move(PointCloud& cloud, std::size_t i, const Vec3& to) {
  if (!to.allFinite()) return lose(cloud, i);
  cloud.x[i] = to.x(), cloud.y[i] = to.y(), cloud.z[i] = to.z();
}

// Returns for each point when its row is read, as a fraction of the readout time: 0 for the first row of the
// image (or the smallest z), 1 for the last row (or the largest z).
std::vector<double> readout(const PointCloud& cloud) {
  std::vector<double> fraction(cloud.size(), 1);
  if (cloud.image) {
    const auto width = static_cast<std::size_t>(cloud.image->camera.width);
    const double last = cloud.image->camera.height - 1;
    for (std::size_t i = 0; last > 0 && i < fraction.size(); ++i) {
      const std::size_t row = i / width;
      fraction[i] = static_cast<double>(row) / last;
    }
    return fraction;
  }
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double z : cloud.z) low = z < low ? z : low, high = z > high ? z : high;  // ignores NaN
  for (std::size_t i = 0; high > low && i < fraction.size(); ++i)
    fraction[i] = (cloud.z[i] - low) / (high - low);
  return fraction;
}

}  // namespace

Parameters parameters(SensorFaults& s) {
  return {
      {"view_direction", &s.view_direction, -1, 1,
       "viewing direction of the sensor; for images the ray of each pixel is used instead"},
      {"repeat_probability", &s.repeat_probability, 0, 1,
       "probability that a frame repeats the previous one"},
      {"rolling_shutter_s", &s.rolling_shutter_s, 0, 10,
       "rolling shutter: time from reading the first row to the last; needs a scene whose true surface is known between frames"},
      {"ray_noise_m", &s.ray_noise.sigma_m, 0, 1,
       "standard deviation of the noise along the viewing direction at 1 m from the sensor; it grows with the square of the distance"},
      {"ray_noise_correlation_m", &s.ray_noise.correlation_m, 0, 10,
       "noise is interpolated between the nodes of a lattice of this pitch across the view, in images at a depth of 1 m; 0: independent in each point"},
      {"ray_noise_memory_fraction", &s.ray_noise.memory, 0, 0.99,
       "correlation m of the noise of successive frames, as behind a filter in time; frames that are n apart have m^n; "
       "0: new noise in every frame"},
      {"sensor_distance_m", &s.sensor_distance_m, 0, 100,
       "distance of the sensor from the origin, against view_direction, for ray_noise_m; in images the distance of each point from the camera is used instead"},
      {"flying_probability", &s.flying_probability, 0, 1,
       "probability that a point is a flying pixel, that is displaced along the viewing direction"},
      {"max_flying_distance_m", &s.max_flying_distance_m, 0, 100,
       "maximum displacement of such a point in either direction, uniformly distributed"},
      {"outlier_probability", &s.outlier_probability, 0, 1,
       "probability that a point is an outlier anywhere along the viewing direction"},
      {"max_outlier_distance_m", &s.max_outlier_distance_m, 0, 100,
       "maximum distance of an outlier from its true position, uniformly distributed"},
      {"quantisation_m", &s.quantisation_m, 0, 1,
       "depth is rounded to multiples of this: along view_direction from the origin, in images along the axis of the "
       "camera from the camera; 0: not rounded"},
      {"hole_fraction", &s.hole_fraction, 0, 1,
       "fraction of the points that are lost in round holes, at new positions in each frame"},
      {"hole_radius_m", &s.hole_radius_m, 1e-4, 10,
       "radius of a hole, perpendicular to the viewing direction"},
      {"dropout_probability", &s.dropout_probability, 0, 1,
       "probability that a point is lost, independently of others"},
      {"late_probability", &s.late_probability, 0, 1,
       "probability that a frame is late; later frames may overtake it"},
      {"late_delay_s", &s.late_delay_s, 0, 100, "additional delay of a late frame"},
  };
}

std::string validate(const SensorFaults& s) {
  return s.view_direction.norm() < 0.001 ? "view_direction: expected a vector of length 0.001 or more" : "";
}

std::vector<std::string> random_faults() {
  std::vector<std::string> names;
  for (const auto& fault : kFaults)
    if ((fault.effects & draws) != 0) names.emplace_back(fault.parameter);
  return names;
}

bool use_view_direction(const SensorFaults& s) {
  return have(s, moves) || s.hole_fraction > 0;
}

FaultySensor::FaultySensor(std::unique_ptr<const Scenario> scenario, const SensorFaults& settings,
                           const NoiseKey& key, const Kernels& kernels)
    : scenario_(std::move(scenario)), settings_(settings), key_(key), kernels_(kernels) {
  if (!validate(settings).empty()) throw std::invalid_argument(validate(settings));
}

int FaultySensor::frame_count() const {
  const bool continues = !ends() && have(settings_, draws | shears);
  return continues ? std::numeric_limits<int>::max() : scenario_->frame_count();
}

int FaultySensor::scenario_frame(int frame) const {
  return std::min(frame, scenario_->frame_count() - 1);
}

int FaultySensor::content_frame(int frame) const {
  while (frame > 0 && uniforms(of_frame(key_, frame), 0)[repeats] < settings_.repeat_probability) --frame;
  return frame;
}

double FaultySensor::captured_s(int frame) const {
  const int last = scenario_frame(frame);
  return scenario_->captured_s(last) + (frame - last) / frame_rate_hz();
}

FrameDelivery FaultySensor::delivery(int frame) const {
  FrameDelivery out = scenario_->delivery(scenario_frame(frame));
  if (frame != scenario_frame(frame)) out.leaves_sensor_s.reset();
  if (uniforms(of_frame(key_, frame), 0)[is_late] < settings_.late_probability)
    out.leaves_sensor_s = out.leaves_sensor_s.value_or(captured_s(frame)) + settings_.late_delay_s;
  return out;
}

std::shared_ptr<const NeighbourSearch> FaultySensor::points(int frame) const {
  if (have(settings_, moves | loses | shears)) return make_search(cloud(frame));
  return scenario_->points(scenario_frame(content_frame(frame)));
}

PointCloud FaultySensor::cloud(int frame) const {
  const int content = content_frame(frame);
  PointCloud cloud = scenario_->cloud(scenario_frame(content));
  ViewCoordinates without_faults;
  if (settings_.hole_fraction > 0 || settings_.ray_noise.sigma_m > 0)
    without_faults = view_coordinates(cloud);
  if (settings_.rolling_shutter_s > 0) shear(cloud, captured_s(content));
  if (settings_.ray_noise.sigma_m > 0) add_ray_noise(cloud, without_faults.positions, content);
  if (have(settings_, moves)) displace(cloud, content);
  if (settings_.hole_fraction > 0) cut_holes(cloud, without_faults, content);
  if (settings_.dropout_probability > 0) drop_points(cloud, content);
  return cloud;
}

Vec3 FaultySensor::viewing_direction(const PointCloud& cloud, const Vec3& p_W) const {
  return (cloud.image ? Vec3(p_W - cloud.image->X_WC.translation()) : settings_.view_direction).normalized();
}

void FaultySensor::shear(PointCloud& cloud, double captured_s) const {
  const std::vector<double> fraction = readout(cloud);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    const Vec3 p_W = cloud.point(i), ray = viewing_direction(cloud, p_W);
    const double then_s = captured_s - (1 - fraction[i]) * settings_.rolling_shutter_s;
    move(cloud, i, earlier_position(p_W, captured_s, then_s, cloud.image ? &ray : nullptr));
  }
}

// Returns the unit vector away from the surface, the normalised gradient of the distance. At edges and
// borders the slopes to both sides differ: the smaller one is used, or 0 if they have opposite signs.
Vec3 FaultySensor::normal_at(const Vec3& p_W, double time_s) const {
  constexpr double kStep_m = 1e-6;
  const double here = scenario_->signed_distance(p_W, time_s);
  Vec3 gradient = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = kStep_m * Vec3::Unit(axis);
    const double after = scenario_->signed_distance(p_W + step, time_s) - here;
    const double before = here - scenario_->signed_distance(p_W - step, time_s);
    if (after * before > 0) gradient[axis] = std::abs(after) < std::abs(before) ? after : before;
  }
  return gradient.normalized();  // 0 stays 0
}

// Returns the position at then_s of the surface point that is at p_W at now_s. The point is displaced along
// the normal by the change of the distance. If ray is not null, the result is the position where the ray of
// this pixel met the surface at then_s. It is NaN if the angle between ray and surface is too small to
// compute that. Returns p_W if the change is 0 or NaN.
Vec3 FaultySensor::earlier_position(const Vec3& p_W, double now_s, double then_s, const Vec3* ray) const {
  constexpr double kMinSlope = 0.1;
  const double change = scenario_->signed_distance(p_W, then_s) - scenario_->signed_distance(p_W, now_s);
  if (change == 0 || std::isnan(change)) return p_W;
  const Vec3 normal = normal_at(p_W, now_s);
  if (!ray) return p_W - change * normal;
  const double slope = normal.dot(*ray);
  if (std::abs(slope) < kMinSlope) return Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  return p_W - change / slope * *ray;
}

// Adds noise along the rays. A point of an image is lost if it would lie behind the camera or at it.
void FaultySensor::add_ray_noise(PointCloud& cloud, const PointCloud& positions, int frame) const {
  const RayNoise& s = settings_.ray_noise;
  const std::vector<double> noise = standard_noise(s, positions, key_, frame, kernels_);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    const Vec3 p_W = cloud.point(i), direction = viewing_direction(cloud, p_W);
    const double distance = cloud.image ? (p_W - cloud.image->X_WC.translation()).norm()
                                        : settings_.sensor_distance_m + p_W.dot(direction);
    const double displacement = s.sigma_m * distance * distance * noise[i];
    if (cloud.image && distance + displacement <= 0)
      lose(cloud, i);
    else
      move(cloud, i, p_W + displacement * direction);
  }
}

// Displaces flying points and outliers, and quantises depths. A point of an image is lost if it would lie
// behind the camera or at it.
void FaultySensor::displace(PointCloud& cloud, int frame) const {
  const SensorFaults& s = settings_;
  const NoiseStream stream = of_points(key_, frame);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    const auto draw = uniforms(stream, static_cast<std::uint32_t>(i));
    const Vec3 p_W = cloud.point(i), direction = viewing_direction(cloud, p_W);
    const double depth_m = cloud.image ? (p_W - cloud.image->X_WC.translation()).norm() : p_W.dot(direction);
    double to = depth_m;
    if (draw[is_outlier] < s.outlier_probability)
      to += (2 * draw[how_far] - 1) * s.max_outlier_distance_m;
    else if (draw[flies] < s.flying_probability)
      to += (2 * draw[how_far] - 1) * s.max_flying_distance_m;
    if (s.quantisation_m > 0) {
      const double axial = cloud.image ? direction.dot(cloud.image->X_WC.linear().col(2)) : 1;
      to = std::round(to * axial / s.quantisation_m) * s.quantisation_m / axial;
    }
    if (cloud.image && to <= 0)
      lose(cloud, i);
    else if (to != depth_m)
      move(cloud, i, p_W + (to - depth_m) * direction);
  }
}

// Returns the position of each point across the view, in x and z: in metres, or, for an image, as the
// position where its ray meets depth 1. Also returns the radius of a hole around each point, in the same
// unit.
FaultySensor::ViewCoordinates FaultySensor::view_coordinates(const PointCloud& cloud) const {
  const Vec3 view_direction = settings_.view_direction.normalized(), across = view_direction.unitOrthogonal(),
             other = view_direction.cross(across);
  const RigidTransform X_CW = cloud.image ? cloud.image->X_WC.inverse() : RigidTransform::Identity();
  ViewCoordinates coordinates;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 p = X_CW * cloud.point(i);
    if (cloud.image)
      coordinates.positions.append({p.x() / p.z(), 0, p.y() / p.z()});
    else
      coordinates.positions.append({across.dot(p), 0, other.dot(p)});
    coordinates.hole_radius.push_back(settings_.hole_radius_m / (cloud.image ? p.z() : 1));
    if (cloud.is_measured(i) && (!cloud.image || p.z() > 0))
      coordinates.measured.push_back(static_cast<std::uint32_t>(i));
  }
  return coordinates;
}

// Cuts holes around points that are drawn one after the other, until at least hole_fraction of the points is
// lost. A point that is already lost can be drawn again.
void FaultySensor::cut_holes(PointCloud& cloud, const ViewCoordinates& coordinates, int frame) const {
  if (coordinates.measured.empty()) return;
  const double count = static_cast<double>(coordinates.measured.size());
  const UniformGridSearch search(coordinates.positions,
                                 coordinates.hole_radius[coordinates.measured.front()]);
  GatheredPoints inside;
  inside.reserve(cloud.size(), false, false);
  std::vector<bool> gone(cloud.size());
  double lost = 0;
  for (std::uint32_t hole = 1; lost < settings_.hole_fraction * count; ++hole) {
    const double drawn = uniforms(of_frame(key_, frame), hole)[0] * count;
    const std::uint32_t middle = coordinates.measured[static_cast<std::size_t>(drawn)];
    inside.clear();
    search.gather({coordinates.positions.point(middle), coordinates.hole_radius[middle]}, kernels_, inside);
    for (std::size_t k = 0; k < inside.size(); ++k) {
      const std::uint32_t i = inside.index()[k];
      if (gone[i]) continue;
      gone[i] = true, ++lost;
      lose(cloud, i);
    }
  }
}

void FaultySensor::drop_points(PointCloud& cloud, int frame) const {
  const NoiseStream stream = of_points(key_, frame);
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (uniforms(stream, static_cast<std::uint32_t>(i))[drops] < settings_.dropout_probability)
      lose(cloud, i);
}

}  // namespace remote_touch
