#include "runners/evaluation/figures/studies/true_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/points/neighbour_search.h"
#include "runners/experiment/catalog/frame_stream.h"
#include "runners/experiment/hand/image_surface.h"
#include "scenarios/recordings/recorded_scene.h"

namespace remote_touch {
namespace {

constexpr int kPixelStep = 3;         // every third row and column is enough to find the middle of an object
constexpr double kMinFacing = 0.5;    // cosine of the largest angle at which a surface is touched
constexpr double kFarthest_m = 0.03;  // a measured depth farther from the true one shows something else
constexpr double kFlatReach_m = 0.015, kFlatWithin_m = 0.003;
constexpr double kWindow_m = 0.045;  // half size that a window shows around its point

std::size_t pixel_of(const CameraIntrinsics& camera, int row, int column) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(camera.width) +
         static_cast<std::size_t>(column);
}

// A frame as the camera has measured it, and as it should have.
struct TruthFrame {
  const RecordedTruth& truth;
  std::size_t source;
  FrameImage measured;
  RasterImage exact;

  const CameraIntrinsics& camera() const { return measured.layout.camera; }
  Vec3 true_point_C(const ImagePixel& at) const {
    return unproject(camera(), at.column, at.row, exact.depth.z_m[pixel_of(camera(), at.row, at.column)]);
  }
};

// The pixels that show one object.
struct ShownObject {
  std::size_t index = 0;
  std::vector<ImagePixel> pixels;
};

// Returns the objects that the frame shows, those with the most pixels first.
std::vector<ShownObject> shown_objects(const TruthFrame& frame) {
  std::vector<ShownObject> shown(frame.truth.objects().size());
  for (std::size_t i = 0; i < shown.size(); ++i) shown[i].index = i;
  for (int row = 0; row < frame.camera().height; row += kPixelStep)
    for (int column = 0; column < frame.camera().width; column += kPixelStep) {
      const int object = frame.exact.mesh[pixel_of(frame.camera(), row, column)];
      if (object >= 0) shown[static_cast<std::size_t>(object)].pixels.push_back({row, column});
    }
  std::stable_sort(shown.begin(), shown.end(), [](const ShownObject& a, const ShownObject& b) {
    return a.pixels.size() > b.pixels.size();
  });
  return shown;
}

bool can_be_touched(const TruthFrame& frame, const ImagePixel& at) {
  const std::size_t pixel = pixel_of(frame.camera(), at.row, at.column);
  const Vec3 normal_C = true_normal_C(frame.truth, frame.source, frame.exact, pixel);
  if (!(-frame.true_point_C(at).normalized().dot(normal_C) >= kMinFacing)) return false;
  const double depth_m = supported_depth(frame.measured.depth, at.column, at.row, frame.camera(), Support{});
  return std::abs(depth_m - frame.exact.depth.z_m[pixel]) <= kFarthest_m;  // false if the depth is NaN
}

// True if the object is flat around the pixel, along the rows, columns and diagonals of the image.
bool is_flat_around(const TruthFrame& frame, const ImagePixel& at) {
  const CameraIntrinsics& camera = frame.camera();
  const std::size_t middle = pixel_of(camera, at.row, at.column);
  const Vec3 p_C = frame.true_point_C(at);
  const Vec3 normal_C = true_normal_C(frame.truth, frame.source, frame.exact, middle);
  const int reach = reach_px(frame.exact.depth, camera.fx, kFlatReach_m, p_C.z());
  for (int down = -1; down <= 1; ++down)
    for (int across = -1; across <= 1; ++across) {
      const ImagePixel beside{at.row + down * reach, at.column + across * reach};
      if (beside.row < 0 || beside.column < 0 || beside.row >= camera.height || beside.column >= camera.width)
        return false;
      if (frame.exact.mesh[pixel_of(camera, beside.row, beside.column)] != frame.exact.mesh[middle])
        return false;
      if (std::abs((frame.true_point_C(beside) - p_C).dot(normal_C)) > kFlatWithin_m) return false;
    }
  return true;
}

// Returns the pixel nearest to the middle of the object, among those that can be touched.
struct Middle {
  ImagePixel pixel;
  bool is_flat;
};
std::optional<Middle> middle_of(const ShownObject& shown, const TruthFrame& frame) {
  double row = 0, column = 0;
  for (const ImagePixel& pixel : shown.pixels) row += pixel.row, column += pixel.column;
  const auto count = static_cast<double>(shown.pixels.size());
  const auto squared_px = [&](const ImagePixel& pixel) {
    const double down = pixel.row - row / count, across = pixel.column - column / count;
    return down * down + across * across;
  };
  std::vector<ImagePixel> touchable;
  for (const ImagePixel& pixel : shown.pixels)
    if (can_be_touched(frame, pixel)) touchable.push_back(pixel);
  std::stable_sort(touchable.begin(), touchable.end(),
                   [&](const ImagePixel& a, const ImagePixel& b) { return squared_px(a) < squared_px(b); });
  for (const ImagePixel& pixel : touchable)
    if (is_flat_around(frame, pixel)) return Middle{pixel, true};
  if (touchable.empty()) return {};
  return Middle{touchable.front(), false};
}

// Returns the rectangle of all pixels within kWindow_m of the point in any of the first frames, one pixel or
// more.
PixelRectangle rectangle_around(const TouchedPoint& point, const RecordedScene& scene, int frames,
                                const CameraIntrinsics& camera) {
  double left = camera.width, right = 0, top = camera.height, bottom = 0;
  for (int frame = 0; frame < frames; ++frame) {
    const auto& X_CO = scene.truth()->poses(scene.source_at(scene.captured_s(frame)))[point.index];
    if (!X_CO) continue;
    const Vec3 p_C = *X_CO * point.p_O;
    if (!(p_C.z() > 0)) continue;
    const double u = camera.fx * p_C.x() / p_C.z() + camera.cx, v = camera.fy * p_C.y() / p_C.z() + camera.cy;
    const double reach_px = camera.fx * kWindow_m / p_C.z();
    left = std::min(left, u - reach_px), right = std::max(right, u + reach_px);
    top = std::min(top, v - reach_px), bottom = std::max(bottom, v + reach_px);
  }
  const auto pixel = [](double at, int size) { return static_cast<int>(std::clamp(at, 0.0, size - 1.0)); };
  const int first_column = pixel(left, camera.width), first_row = pixel(top, camera.height);
  return {first_column, first_row, std::max(1, pixel(right, camera.width) - first_column + 1),
          std::max(1, pixel(bottom, camera.height) - first_row + 1)};
}

// Returns the pixels of the rectangle as an image of their own.
PointCloud cut_out(const PointCloud& cloud, const PixelRectangle& at) {
  PointCloud window;
  window.image = cloud.image;
  CameraIntrinsics& camera = window.image->camera;
  camera.width = at.width, camera.height = at.height;
  camera.cx -= at.left, camera.cy -= at.top;
  for (int row = at.top; row < at.top + at.height; ++row)
    for (int column = at.left; column < at.left + at.width; ++column)
      window.append(cloud.point(pixel_of(cloud.image->camera, row, column)));
  return window;
}

}  // namespace

RasterImage true_image(const RecordedTruth& truth, std::size_t source, const CameraIntrinsics& camera) {
  std::vector<RasterMesh> meshes;
  for (std::size_t i = 0; i < truth.objects().size(); ++i) {
    const MeshObject& object = truth.objects()[i];
    const std::optional<RigidTransform>& X_CO = truth.poses(source)[i];
    meshes.push_back(
        {object.shape->vertices(), {}, X_CO.value_or(RigidTransform::Identity()), object.is_closed});
    if (X_CO) meshes.back().triangles = object.shape->triangles();
  }
  return depth_raster(camera, meshes);
}

Vec3 true_normal_C(const RecordedTruth& truth, std::size_t source, const RasterImage& image,
                   std::size_t pixel) {
  const auto object = static_cast<std::size_t>(image.mesh[pixel]);
  const MeshDistance& shape = *truth.objects()[object].shape;
  const auto& [a, b, c] = shape.triangles()[static_cast<std::size_t>(image.triangle[pixel])];
  const auto corner = [&](int i) -> const Vec3& { return shape.vertices()[static_cast<std::size_t>(i)]; };
  const Vec3 normal_O = (corner(b) - corner(a)).cross(corner(c) - corner(a)).normalized();
  const RigidTransform& X_CO = *truth.poses(source)[object];
  const Vec3 normal_C = X_CO.linear() * normal_O;
  return normal_C.dot(X_CO * corner(a)) > 0 ? Vec3(-normal_C) : normal_C;
}

std::vector<TouchedPoint> touched_points(const RecordedScene& scene, int frame_number, std::size_t most) {
  constexpr const char* kSubject = "the truth of a recording";
  const RecordedTruth& truth = *scene.truth();
  const std::size_t source = scene.source_at(scene.captured_s(frame_number));
  FrameImage measured = image_of(scene, frame_number, first_image(scene, kSubject).layout, kSubject);
  RasterImage exact = true_image(truth, source, measured.layout.camera);
  const TruthFrame frame{truth, source, std::move(measured), std::move(exact)};
  std::vector<TouchedPoint> points;
  for (const ShownObject& shown : shown_objects(frame)) {
    if (points.size() == most) break;
    const std::optional<Middle> middle = middle_of(shown, frame);
    if (!middle) continue;
    const Vec3 p_C = frame.true_point_C(middle->pixel);
    const std::size_t pixel = pixel_of(frame.camera(), middle->pixel.row, middle->pixel.column);
    const Vec3 outwards_C =
        middle->is_flat ? true_normal_C(truth, source, frame.exact, pixel) : Vec3(-p_C.normalized());
    const RigidTransform X_OC = truth.poses(source)[shown.index]->inverse();
    points.push_back(
        {truth.objects()[shown.index].name, shown.index, X_OC * p_C, X_OC.linear() * outwards_C});
  }
  return points;
}

RecordingWindow::RecordingWindow(const RecordedScene& scene, const TouchedPoint& point, int frames)
    : scene_(scene),
      point_(point),
      rectangle_(rectangle_around(point, scene, frames, scene.points(0)->stored_cloud()->image->camera)) {}

void RecordingWindow::add_frame() {
  const int number = frame_count();
  const double time_s = scene_.captured_s(number);
  const PointCloud& cloud = *scene_.points(number)->stored_cloud();
  const std::size_t source = scene_.source_at(time_s);
  const RigidTransform X_WC = cloud.image->X_WC;
  if (const auto& X_CO = scene_.truth()->poses(source)[point_.index]) X_WO_ = X_WC * *X_CO;
  frames_.push_back({make_search(cut_out(cloud, rectangle_)), X_WC, source, X_WO_ * point_.p_O,
                     X_WO_.linear() * point_.outwards_O});
}

PointCloud RecordingWindow::cloud(int frame) const {
  return *frame_at(frame).points->stored_cloud();
}

double RecordingWindow::signed_distance(const Vec3& p_W, double time_s) const {
  const WindowFrame& frame = frame_at(newest_frame(time_s));
  if (!p_W.allFinite()) return std::numeric_limits<double>::quiet_NaN();
  return scene_.truth()->at(frame.source, frame.X_WC.inverse() * p_W).distance_m;
}

std::optional<double> RecordingWindow::measured_distance(const Vec3& p_W, double time_s) const {
  return distance_to_measured(*frame_at(newest_frame(time_s)).points->stored_cloud(), p_W,
                              RecordedScene::Settings().truth_radius_m);
}

std::vector<std::unique_ptr<const RecordingWindow>> windows_around(const std::vector<TouchedPoint>& points,
                                                                   const RecordedScene& scene, int frames) {
  std::vector<std::unique_ptr<RecordingWindow>> windows;
  for (const TouchedPoint& point : points)
    windows.push_back(std::make_unique<RecordingWindow>(scene, point, frames));
  for (int frame = 0; frame < frames; ++frame)
    for (const auto& window : windows) window->add_frame();
  return {std::make_move_iterator(windows.begin()), std::make_move_iterator(windows.end())};
}

namespace {

using Json = nlohmann::ordered_json;

constexpr double kPressed_m = 0.01, kApproached_m = 0.03, kApproach_s = 0.1;
constexpr int kCycle = 15, kApproach = 3;  // frames from one press to the next, and of its approach

// Returns the trajectory `poses` of the hand. At the end it presses for as long as an approach takes, so that
// a recording of few frames is touched too.
Json pressing_poses(const RecordingWindow& window) {
  Json poses = Json::array();
  const auto add = [&](int frame, double approached, double duration_s) {
    const Vec3 hand_W = window.p_W(frame) + (kApproached_m - approached * (kApproached_m + kPressed_m)) *
                                                window.outwards_W(frame);
    poses.push_back({hand_W.x(), hand_W.y(), hand_W.z(), 0, 0, 0, duration_s});
  };
  const int frames = window.frame_count();
  for (int frame = 0; frame < frames; ++frame)
    add(frame, std::min(1.0, static_cast<double>(frame % kCycle) / kApproach),
        frame == 0 ? 0 : window.captured_s(frame) - window.captured_s(frame - 1));
  add(frames - 1, 1, kApproach_s);
  return {{"name", "poses"}, {"poses", poses}};
}

Vec3 contact_of(const RenderOutput& out, const RecordingWindow& window, double rest_distance_m,
                double time_s) {
  const Vec3 unknown = Vec3::Constant(kNoValue);
  if (out.state == ContactState::free) return unknown;
  const Vec3 contact_W = out.proxy_W - rest_distance_m * out.normal_W;
  const bool is_in_front = out.normal_W.dot(window.camera_W(time_s) - contact_W) > 0;
  return is_in_front ? contact_W : unknown;
}

}  // namespace

Experiment pressing_experiment(const Json& scenario, const RecordingWindow& window, const Toucher& toucher) {
  Json configuration = {
      {"title", toucher.name + " pressed onto " + window.point().object + ", which is held by its true pose"},
      {"scenario", scenario}};
  if (!toucher.depth_pipeline.empty()) configuration["depth_pipeline"] = Json::parse(toucher.depth_pipeline);
  configuration["renderer"] = Json::parse(toucher.renderer);
  configuration["trajectory"] = pressing_poses(window);
  configuration["duration_s"] = window.captured_s(window.frame_count() - 1) + kApproach_s;
  return Experiment::from_json(configuration);
}

std::vector<Vec3> contact_points(const Experiment& experiment, const RecordingWindow& window,
                                 double rest_distance_m, const Kernels& kernels) {
  const RunSettings& settings = experiment.settings();
  const auto trajectory = experiment.build_trajectory(window);
  std::unique_ptr<Renderer> renderer;
  FrameStream frames(window, experiment.build_processing(kernels), settings.transport, settings.key, false);
  std::vector<Vec3> contacts_W(static_cast<std::size_t>(window.frame_count()), Vec3::Constant(kNoValue));
  const auto ticks = static_cast<int>(std::ceil(settings.duration_s * settings.haptic_rate_hz - 1e-6));
  int last = -1;
  for (int tick = 0; tick < ticks; ++tick) {
    const double time_s = tick / settings.haptic_rate_hz;
    const int frame = window.newest_frame(time_s);
    if (frame / kCycle != last / kCycle || !renderer) renderer = experiment.build_renderer(kernels);
    last = frame;
    frames.deliver_until(time_s, *renderer);
    const RenderOutput out = renderer->step(trajectory->at(time_s), time_s);
    if (tick + 1 == ticks || window.newest_frame((tick + 1) / settings.haptic_rate_hz) != frame)
      contacts_W[static_cast<std::size_t>(frame)] = contact_of(out, window, rest_distance_m, time_s);
  }
  return contacts_W;
}

std::vector<ContactError> contact_errors(const std::vector<Vec3>& contacts_W, const RecordingWindow& window) {
  std::vector<ContactError> errors;
  for (std::size_t frame = 0; frame < contacts_W.size(); ++frame) {
    const double time_s = window.captured_s(static_cast<int>(frame));
    const double renderer_m = *window.measured_distance(contacts_W[frame], time_s);
    const double camera_m = window.signed_distance(contacts_W[frame], time_s) - renderer_m;
    errors.push_back(std::isnan(camera_m) ? ContactError() : ContactError{renderer_m, camera_m});
  }
  return errors;
}

void keep_common_frames(std::vector<std::vector<ContactError>>& runs) {
  if (runs.empty()) return;
  for (std::size_t frame = 0; frame < runs[0].size(); ++frame) {
    const auto is_unknown = [frame](const auto& run) { return std::isnan(run[frame].total_m()); };
    if (std::any_of(runs.begin(), runs.end(), is_unknown))
      for (std::vector<ContactError>& run : runs) run[frame] = {};
  }
}

ErrorStatistics statistics_of(const std::vector<ContactError>& errors, ErrorValue value, double offset_m) {
  double count = 0, sum = 0, squares = 0;
  for (const ContactError& error : errors) {
    const double value_m = value(error) + offset_m;
    if (std::isnan(value_m)) continue;
    ++count, sum += value_m, squares += value_m * value_m;
  }
  if (count == 0) return {};
  return {count, std::sqrt(squares / count), sum / count};
}

double frame_noise_m(const std::vector<ContactError>& errors, ErrorValue value) {
  double count = 0, squares = 0;
  for (std::size_t i = 1; i < errors.size(); ++i) {
    const double change_m = value(errors[i]) - value(errors[i - 1]);
    if (std::isnan(change_m)) continue;
    ++count, squares += change_m * change_m;
  }
  return count == 0 ? kNoValue : std::sqrt(squares / (2 * count));
}

}  // namespace remote_touch
