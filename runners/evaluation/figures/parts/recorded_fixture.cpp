#include "runners/evaluation/figures/parts/recorded_fixture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/points/number_columns.h"

namespace remote_touch {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr int kAround_px = 10;  // 1 cm at 0.6 m

// Index of a frame in the recording, which plays forwards and backwards: 0 1 2 3 2 1 0 1 ...
int recorded_frame(int frame, int count) {
  const int cycle = std::max(1, 2 * count - 2), index = frame % cycle;
  return index < count ? index : cycle - index;
}

double median_or_unknown(std::vector<double> values) {
  return values.empty() ? kUnknown : median_in_place(values);
}

struct Pixel {
  int u, v;
};

// pre: in front of the camera, whose frame is the world's.
Pixel pixel_of(const Vec3& p, const CameraIntrinsics& camera) {
  return {static_cast<int>(std::floor(camera.fx * p.x() / p.z() + camera.cx + 0.5)),
          static_cast<int>(std::floor(camera.fy * p.y() / p.z() + camera.cy + 0.5))};
}

double nearest_distance_m(const Vec3& p, const PointCloud& cloud) {
  double squared = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double d = (cloud.point(i) - p).squaredNorm();
    squared = d < squared ? d : squared;  // a NaN is not less, so it is skipped
  }
  return std::isinf(squared) ? kUnknown : std::sqrt(squared);
}

double hidden_m(const Vec3& p, const PointCloud& cloud) {
  const CameraIntrinsics& camera = cloud.image->camera;
  const Pixel at = pixel_of(p, camera);
  if (at.u < 0 || at.v < 0 || at.u >= camera.width || at.v >= camera.height) return kUnknown;
  return p.z() - cloud.z[static_cast<std::size_t>(at.v) * camera.width + at.u];
}

// Motion from one frame of the recording to the next.
struct Motion {
  double camera_position_m = 0, surface_m = 0;
};

Motion motion(const PointCloud& before, const PointCloud& after, Pixel pressed) {
  const CameraIntrinsics& camera = after.image->camera;
  std::vector<double> everywhere, here;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * camera.width + u;
      const Vec3 displacement = after.point(i) - before.point(i);
      if (!displacement.allFinite()) continue;
      everywhere.push_back(displacement.norm());
      if (std::abs(u - pressed.u) <= kAround_px && std::abs(v - pressed.v) <= kAround_px)
        here.push_back(-displacement.z());
    }
  }
  return {median_or_unknown(std::move(everywhere)), median_or_unknown(std::move(here))};
}

std::vector<FrameOutcome> last_ticks(const Trace& trace) {
  std::vector<FrameOutcome> outcomes;
  for (std::size_t i = 0; i < trace.length(); ++i)
    if (i + 1 == trace.length() || trace.frame_update(i + 1)) outcomes.push_back({i});
  return outcomes;
}

int recorded_frame_count(const Experiment& experiment) {
  const InputPart part = experiment.inputs().front();
  const FrameRange frames = frames_of(part, index_recording(find_input(part.path)));
  return frames.last - frames.first + 1;
}

}  // namespace

// Goes through the frames in the order of the recording, so that each is read once.
std::vector<FrameOutcome> frame_outcomes(const Experiment& experiment, const Trace& trace,
                                         const Scenario& scenario) {
  std::vector<FrameOutcome> outcomes = last_ticks(trace);
  const int count = recorded_frame_count(experiment);
  std::vector<Motion> to(static_cast<std::size_t>(count));  // motion to each frame from the one before
  PointCloud before;
  for (int index = 0; index < count; ++index) {
    PointCloud cloud = scenario.cloud(index);
    if (index > 0)
      to[static_cast<std::size_t>(index)] =
          motion(before, cloud, pixel_of(trace.hip_position_m[0], cloud.image->camera));
    for (FrameOutcome& outcome : outcomes) {
      if (recorded_frame(trace.frame_index[outcome.tick], count) != index) continue;
      outcome.nearest_distance_m = nearest_distance_m(trace.proxy_position_m[outcome.tick], cloud);
      outcome.hidden_m = hidden_m(trace.proxy_position_m[outcome.tick], cloud);
    }
    before = std::move(cloud);
  }
  for (FrameOutcome& outcome : outcomes) {
    const int frame = trace.frame_index[outcome.tick];
    if (frame <= 0) continue;
    const int now = recorded_frame(frame, count), last = recorded_frame(frame - 1, count);
    const Motion& step = to[static_cast<std::size_t>(std::max(now, last))];
    outcome.camera_motion_m = step.camera_position_m;
    outcome.surface_motion_m = now > last ? step.surface_m : -step.surface_m;  // played backwards
  }
  return outcomes;
}

std::vector<PopThrough> pop_throughs(const Trace& trace, const Scenario& scenario) {
  std::vector<PopThrough> found;
  double known_m = kUnknown;  // the newest distance that is known
  for (std::size_t i = 0; i < trace.length(); ++i) {
    const double distance_m = trace.signed_distance_m[i];
    if (std::isnan(distance_m)) continue;
    if (known_m >= 0 && distance_m < 0) {
      PopThrough pop{i, kUnknown};
      // The second distance is that of the proxy when the frame arrived, before its first step.
      if (trace.frame_update(i) && !std::isnan(trace.signed_distance_m[i - 1]))
        pop.surface_motion_m =
            trace.signed_distance_m[i - 1] -
            scenario.signed_distance(trace.proxy_position_m[i - 1] + trace.frame_correction_m[i],
                                     trace.time_s[i]);
      found.push_back(pop);
    }
    known_m = distance_m;
  }
  return found;
}

}  // namespace remote_touch
