#include "scenarios/recordings/pose_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "scenarios/meshes/object_view.h"
#include "scenarios/meshes/recorded_truth.h"

namespace remote_touch {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr std::size_t kComparedPixels = 2000;

// Another meaning of the poses is named if its gap is less than this share of the gap of the poses as they
// are read.
constexpr double kMuchLess = 0.5;
constexpr double kSmallGap_m = 0.005;  // errors of cameras and poses reach this size

double median(std::vector<double> values) {
  if (values.empty()) return kInfinite;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Returns the median, or infinity if fewer than `least` values are known.
double known_median(std::vector<double> values, double least) {
  return static_cast<double>(values.size()) >= std::max(least, 1.0) ? median(std::move(values)) : kInfinite;
}

// Distance with its unit: "31.2 mm", "400 m".
std::string length(double distance_m) {
  char text[32];
  if (distance_m < 1)
    std::snprintf(text, sizeof text, "%.3g mm", 1e3 * distance_m);
  else
    std::snprintf(text, sizeof text, "%.4g m", distance_m);
  return text;
}

// The meaning with the smallest gap, and that gap.
struct Best {
  const OtherMeaning* meaning = nullptr;
  double gap_m = kInfinite;
};

Best best_of(const std::vector<std::vector<double>>& gaps) {
  Best best;
  for (std::size_t i = 1; i < gaps.size(); ++i)
    if (const double gap_m = median(gaps[i]); gap_m < best.gap_m) best = {&other_meanings()[i - 1], gap_m};
  return best;
}

const OtherMeaning* meaning_of(std::size_t i) {
  return i == 0 ? nullptr : &other_meanings()[i - 1];
}

std::vector<Vec3> compared_points(const PointCloud& cloud, const RigidTransform& X_CW) {
  std::vector<Vec3> points_C;
  const std::size_t step = 1 + cloud.size() / kComparedPixels;
  for (std::size_t i = 0; i < cloud.size(); i += step)
    if (cloud.is_measured(i)) points_C.push_back(X_CW * cloud.point(i));
  return points_C;
}

// Returns the distances, along the depth, of moved points from what an image shows there. depth_of: returns
// the depth of a pixel.
template <class DepthOf>
std::vector<double> gaps_of(const std::vector<Vec3>& points, const RigidTransform& X,
                            const CameraIntrinsics& camera, DepthOf&& depth_of) {
  std::vector<double> gaps;
  for (const Vec3& point : points) {
    const Vec3 p_C = X * point;
    const std::optional<std::size_t> pixel = pixel_of(camera, p_C);
    if (!pixel) continue;
    if (const double depth_m = depth_of(*pixel); std::isfinite(depth_m))
      gaps.push_back(std::abs(depth_m - p_C.z()));
  }
  return gaps;
}

}  // namespace

void PoseFit::set_anchor(std::size_t frame, const PointCloud& cloud, const RigidTransform& X_CW) {
  anchor_ = {frame, cloud.image->camera, {}};
  for (std::size_t i = 0; i < cloud.size(); ++i) anchor_.depth_m.push_back((X_CW * cloud.point(i)).z());
}

void PoseFit::add_motion(std::size_t frame, const PointCloud& cloud, const CameraPath& path) {
  constexpr std::size_t kMostApart = 10;  // frames
  constexpr double kLeastShare = 0.1, kLeftShare = 0.5;
  if (!path.moves() || !cloud.image) return;
  const RigidTransform X_CW = cloud.image->X_WC.inverse();
  if (anchor_.depth_m.empty()) return set_anchor(frame, cloud, X_CW);
  const std::vector<Vec3> points_C = compared_points(cloud, X_CW);
  const auto count = static_cast<double>(points_C.size());
  const auto depth_of = [this](std::size_t pixel) { return anchor_.depth_m[pixel]; };
  gaps_.resize(1 + other_meanings().size());
  std::size_t in_anchor = 0;
  for (std::size_t i = 0; i < gaps_.size(); ++i) {
    const auto X_BC = path.pose_if(meaning_of(i), frame), X_BA = path.pose_if(meaning_of(i), anchor_.frame);
    if (!X_BC || !X_BA) return;
    const std::vector<double> gaps = gaps_of(points_C, X_BA->inverse() * *X_BC, anchor_.camera, depth_of);
    gaps_[i].push_back(known_median(gaps, kLeastShare * count));
    if (i == 0) in_anchor = gaps.size();
  }
  still_gaps_.push_back(
      known_median(gaps_of(points_C, RigidTransform::Identity(), anchor_.camera, depth_of), 1));
  const std::size_t apart = std::max(frame, anchor_.frame) - std::min(frame, anchor_.frame);
  if (apart >= kMostApart || static_cast<double>(in_anchor) < kLeftShare * count)
    set_anchor(frame, cloud, X_CW);
}

std::vector<Note> PoseFit::motion_notes(const CameraPath& path) const {
  constexpr double kWorse = 1.25, kNoise_m = 0.001;
  if (still_gaps_.empty()) return {};
  const double gap_m = median(gaps_[0]), still_m = median(still_gaps_);
  const Best best = best_of(gaps_);
  const bool is_worse = gap_m > kWorse * still_m + kNoise_m;
  const bool is_beaten = gap_m > kSmallGap_m && best.gap_m < kMuchLess * gap_m;
  if (!is_worse && !is_beaten) return {};
  std::string text =
      path.file().file.filename().string() + ": " +
      (std::isfinite(gap_m) ? "with these poses the frames differ by " + length(gap_m)
                            : std::string("with these poses the frames show different places")) +
      " (median of the depth), without poses by " + length(still_m);
  if (best.meaning && best.gap_m < kMuchLess * gap_m && best.gap_m <= still_m)
    text += std::string(", with ") + best.meaning->text + " by " + length(best.gap_m) +
            (best.meaning == other_meanings().data() ? ": scenario.pose_direction may be the other one"
                                                     : ": this may be what the file has");
  else
    text += ": the poses may be those of other frames, or in another order";
  return {{"poses do not fit", text}};
}

void PoseFit::add_truth(std::size_t frame, const PointCloud& cloud, const RecordedTruth& truth) {
  constexpr double kLeastShare = 0.05;
  if (!cloud.image) return;
  const CameraIntrinsics& camera = cloud.image->camera;
  const RigidTransform X_CW = cloud.image->X_WC.inverse();
  const auto depth_of = [&](std::size_t pixel) { return (X_CW * cloud.point(pixel)).z(); };
  objects_.resize(truth.objects().size());
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const std::optional<RigidTransform>& X_CO = truth.poses(frame)[i];
    if (!X_CO) continue;
    ObjectFit& fit = objects_[i];
    fit.gaps.resize(1 + other_meanings().size());
    ++fit.frames;
    fit.frames_in_image += count_in_image(truth.samples()[i], *X_CO, camera) > 0 ? 1 : 0;
    for (std::size_t m = 0; m < fit.gaps.size(); ++m) {
      const RigidTransform X = m == 0 ? *X_CO : meaning_of(m)->of(*X_CO);
      std::vector<Vec3> facing_O;
      for (const SampledPoint& sample : truth.samples()[i])
        if ((X.linear() * sample.normal).dot(X * sample.point) < 0) facing_O.push_back(sample.point);
      const std::vector<double> gaps = gaps_of(facing_O, X, camera, depth_of);
      fit.gaps[m].push_back(known_median(gaps, kLeastShare * static_cast<double>(facing_O.size())));
      if (m > 0) continue;
      fit.measured += gaps.size();
      fit.near += static_cast<std::size_t>(
          std::count_if(gaps.begin(), gaps.end(), [&](double gap) { return gap <= truth.reach_m(); }));
    }
  }
}

std::vector<Note> PoseFit::truth_notes(const RecordedTruth& truth) const {
  constexpr double kLeastShareNear = 0.1;
  std::vector<Note> notes;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const ObjectFit& fit = objects_[i];
    if (fit.frames == 0) continue;
    const double gap_m = median(fit.gaps[0]);
    const Best best = best_of(fit.gaps);
    const bool is_elsewhere =
        static_cast<double>(fit.near) <= kLeastShareNear * static_cast<double>(fit.measured);
    const bool is_beaten =
        gap_m > kSmallGap_m && best.gap_m < kMuchLess * gap_m && best.gap_m <= truth.reach_m();
    if (!is_elsewhere && !is_beaten) continue;
    std::string text = "the true object " + truth.objects()[i].name;
    if (fit.frames_in_image == 0)
      text += " is outside the image in all " + std::to_string(fit.frames) + " frames that were read";
    else if (std::isfinite(gap_m))
      text += " is " + length(gap_m) + " from what the camera measured there (median of the depth)";
    else
      text += " is where the camera measured nothing";
    if (best.meaning && best.gap_m < kMuchLess * gap_m && best.gap_m <= truth.reach_m())
      text += std::string("; with ") + best.meaning->text + " it is " + length(best.gap_m) +
              " from it: expected object frame to camera frame, metres";
    notes.push_back({"truth elsewhere", text});
  }
  return notes;
}

}  // namespace remote_touch
