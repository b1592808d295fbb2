#include "runners/experiment/simulation/surface_watch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/numeric/order_statistic.h"
#include "core/search/neighbour_search.h"

namespace remote_touch {

double shown_depth(const PointCloud& cloud, const RigidTransform& X_CW, const Vec3& p_C, double reach_m) {
  constexpr double kMaxReach_px = 32;  // bounds the work for a hand close to the lens
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  const CameraIntrinsics& camera = cloud.image->camera;
  if (!(p_C.z() > 0)) return unknown;
  const double column = std::floor(camera.fx * p_C.x() / p_C.z() + camera.cx + 0.5);
  const double row = std::floor(camera.fy * p_C.y() / p_C.z() + camera.cy + 0.5);
  if (!(column >= 0 && row >= 0 && column < camera.width && row < camera.height)) return unknown;
  const int u = static_cast<int>(column), v = static_cast<int>(row);
  const auto reach_px = [&](double focal_px) {
    return static_cast<int>(std::clamp(focal_px * reach_m / p_C.z(), 1.0, kMaxReach_px));
  };
  const int across = reach_px(camera.fx), down = reach_px(camera.fy);
  std::vector<double> depths;
  for (int y = std::max(0, v - down); y <= std::min<int>(camera.height - 1, v + down); ++y)
    for (int x = std::max(0, u - across); x <= std::min<int>(camera.width - 1, u + across); ++x) {
      const int right = (x - u) * down, below = (y - v) * across;
      if (right * right + below * below > across * across * down * down) continue;
      const std::size_t i = static_cast<std::size_t>(y) * camera.width + x;
      if (cloud.is_measured(i)) depths.push_back((X_CW * cloud.point(i)).z());
    }
  return depths.empty() ? unknown : median_in_place(depths);
}

// Returns the newest frame at a time; null if it is not an image.
const PointCloud* SurfaceWatch::image_at(double time_s) {
  const int frame = std::clamp(scenario_.newest_frame(time_s), 0, scenario_.frame_count() - 1);
  if (frame == frame_) return cloud_;
  frame_ = frame;
  points_ = scenario_.points(frame);
  // An ImageWindowSearch stores the points in the order of the pixels. The frame is copied for any other
  // search.
  if (const auto* image = dynamic_cast<const ImageWindowSearch*>(points_.get())) {
    cloud_ = &image->cloud();
  } else {
    copy_ = scenario_.cloud(frame);
    cloud_ = &*copy_;
  }
  const auto is_image = [](const PointCloud& cloud) {
    if (!cloud.image) return false;
    const CameraIntrinsics& camera = cloud.image->camera;
    return cloud.size() == camera.pixels();
  };
  if (!is_image(*cloud_)) return cloud_ = nullptr;
  X_CW_ = cloud_->image->X_WC.inverse();
  return cloud_;
}

void SurfaceWatch::add_step(const Vec3& hand_W, double time_s, double max_step_m) {
  const double step_m = last_W_ ? (hand_W - *last_W_).norm() : 0;
  last_W_ = hand_W;
  if (max_step_m <= 0 || !(step_m > max_step_m)) return;
  if (jumps_++ == 0) first_jump_s_ = time_s, first_jump_m_ = step_m;
  longest_jump_m_ = std::max(longest_jump_m_, step_m);  // no NaN: above a limit
}

void SurfaceWatch::add(const Vec3& hand_W, double time_s) {
  const std::optional<SurfacePlan> plan = trajectory_.surface_plan(time_s);
  if (!plan) return;
  add_step(hand_W, time_s, plan->max_step_m);
  const PointCloud* cloud = image_at(time_s);
  if (!cloud) return;
  ++ticks_;
  const Vec3 hand_C = X_CW_ * hand_W;
  const double behind_m = hand_C.z() - shown_depth(*cloud, X_CW_, hand_C, plan->reach_m);
  if (behind_m > plan->max_depth_m) {
    if (behind_++ == 0) first_behind_s_ = time_s;
    if (behind_m > deepest_m_) deepest_m_ = behind_m, allowed_m_ = plan->max_depth_m;
  } else if (plan->touches && !(behind_m >= plan->min_depth_m)) {  // also if behind_m is NaN
    if (off_++ == 0) first_off_s_ = time_s;
  }
}

std::vector<Note> SurfaceWatch::notes() const {
  std::vector<Note> notes;
  char text[240];
  const auto percent = [&](std::size_t count) {
    return 100 * static_cast<double>(count) / static_cast<double>(ticks_);
  };
  if (behind_ > 0) {
    std::snprintf(text, sizeof text,
                  "the hand was behind the surface that the camera sees in %.3g %% of the ticks, first at "
                  "%.6g s, by up to %.3g mm; at most %.3g mm were planned",
                  percent(behind_), first_behind_s_, 1e3 * deepest_m_, 1e3 * allowed_m_);
    notes.push_back({"behind the surface", text});
  }
  if (off_ > 0) {
    std::snprintf(
        text, sizeof text,
        "the hand was meant to touch but was off the surface that the camera sees in %.3g %% of the "
        "ticks, first at %.6g s: there is a hole or an edge, or the surface has moved",
        percent(off_), first_off_s_);
    notes.push_back({"off the surface", text});
  }
  if (jumps_ > 0) {
    std::snprintf(text, sizeof text,
                  "the hand jumped by %.3g mm at %.6g s, because its pixel then showed another surface",
                  1e3 * first_jump_m_, first_jump_s_);
    notes.push_back({"hand jumped", text});
    if (jumps_ > 1) {
      std::snprintf(text, sizeof text, "; it jumped %zu times, by up to %.3g mm", jumps_,
                    1e3 * longest_jump_m_);
      notes.back().text += text;
    }
  }
  return notes;
}

}  // namespace remote_touch
