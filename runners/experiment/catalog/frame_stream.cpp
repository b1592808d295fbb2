#include "runners/experiment/catalog/frame_stream.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <string>
#include <utility>

#include "analysis/trace/hash64.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/sessions/sensor_cloud.h"

namespace remote_touch {

namespace {

class ScenarioTruth final : public TrueSurface {
 public:
  explicit ScenarioTruth(const Scenario& scenario) : scenario_(scenario) {}
  double signed_distance(const Vec3& p_W, double time_s) const override {
    return scenario_.signed_distance(p_W, time_s);
  }

 private:
  const Scenario& scenario_;
};

}  // namespace

// The hash includes the time of capture: the same points with another time stamp are another frame.
std::uint64_t frame_hash(const PointCloud& cloud, double captured_s) {
  return mixed(points_hash(cloud), std::bit_cast<std::uint64_t>(captured_s));
}

void FrameProcessing::fill(Frame& frame, PointCloud cloud, std::uint64_t off) const {
  if (depth) {
    if (!cloud.image)
      throw InputError("depth_pipeline", "this scenario's frames are not depth images: expected none");
    const std::optional<HueSteps> steps = fixtures.hue_steps(frame.captured_s, off);
    if (steps && depth->process_all(cloud, *steps)) {
      frame.points = make_search(std::move(cloud));
      return;
    }
    depth->process(cloud);
  }
  apply_fixtures(frame, std::move(cloud), off);
}

void FrameProcessing::fill(Frame& frame, const SensorFrame& sensed, const SensorView& view,
                           const RigidTransform& X_WC, std::uint64_t off) const {
  if (depth && !view.cloud) {
    const std::optional<HueSteps> steps = fixtures.hue_steps(frame.captured_s, off);
    PointCloud cloud;
    if (depth->process_all({sensed.depth.data(), view.metres_per_unit, view.camera, X_WC, sensed.colour},
                           cloud, steps ? &*steps : nullptr)) {
      if (steps)  // there are no targets, because all rules are forbidden regions
        frame.points = make_search(std::move(cloud));
      else
        apply_fixtures(frame, std::move(cloud), off);
      return;
    }
  }
  fill(frame, cloud_of(sensed, view, X_WC), off);
}

// Adds the number of the frame to the error of a rule. A rule refuses a frame that lacks the colours which it
// needs, but it does not know the number of the frame.
void FrameProcessing::apply_fixtures(Frame& frame, PointCloud cloud, std::uint64_t off) const {
  try {
    frame.guidance = fixtures.targets(cloud, frame.captured_s);
    fixtures.assign(cloud, frame.captured_s, off);
  } catch (const InputError& error) {
    throw InputError("frame " + std::to_string(frame.index), error.what());
  }
  frame.points = make_search(std::move(cloud));
}

FrameStream::FrameStream(const Scenario& scenario, FrameProcessing processing, const Transport& transport,
                         const NoiseKey& key, bool hash_frames, bool generate_all_points)
    : scenario_(scenario),
      truth_(std::make_shared<ScenarioTruth>(scenario)),
      processing_(std::move(processing)),
      transport_(transport),
      key_(key),
      hash_frames_(hash_frames),
      generate_all_points_(generate_all_points) {}

// The camera continues at its rate after the last frame of the scenario, and repeats that frame: only so does
// a renderer see that a surface which moved is at rest. The only frame of a scene shows no motion, so it is
// repeated only if a repetition can come earlier, come in its place, or show other fixtures.
bool FrameStream::exists(int frame) const {
  const int count = scenario_.frame_count();
  if (frame < count) return true;
  const bool matters = count > 1 || processing_.fixtures.changes_with_time() ||
                       transport_.drop_probability > 0 || transport_.jitter_s > 0;
  return matters && !scenario_.ends();
}

int FrameStream::source_frame(int frame) const {
  return std::min(frame, scenario_.frame_count() - 1);
}

double FrameStream::captured_s(int frame) const {
  return scenario_.captured_s(source_frame(frame)) +
         (frame - source_frame(frame)) / scenario_.frame_rate_hz();
}

void FrameStream::send(int frame) {
  const auto chance = uniforms(noise_stream(key_, NoiseUse::transport, static_cast<std::uint32_t>(frame)), 0);
  if (chance[0] < transport_.drop_probability) return;
  std::optional<double> delayed_leave_s;  // time at which the frame leaves the sensor, if not at its capture
  if (frame == source_frame(frame)) delayed_leave_s = scenario_.leaves_sensor_s(frame);
  const double leaves_sensor_s = delayed_leave_s.value_or(captured_s(frame));
  const FrameInTransit sent{leaves_sensor_s + transport_.latency_s + chance[1] * transport_.jitter_s, frame};
  const auto after = [](const FrameInTransit& a, const FrameInTransit& b) {
    return a.arrives_s < b.arrives_s;
  };
  in_transit_.insert(std::upper_bound(in_transit_.begin(), in_transit_.end(), sent, after), sent);
}

void FrameStream::deliver_until(double time_s, Renderer& renderer) {
  const double now_s = time_s + kSameTime_s;
  while (exists(next_) && captured_s(next_) + transport_.latency_s <= now_s) send(next_++);
  while (!in_transit_.empty() && in_transit_.front().arrives_s <= now_s) {
    const FrameInTransit arrived = in_transit_.front();
    in_transit_.erase(in_transit_.begin());
    Frame frame{arrived.frame, captured_s(arrived.frame), arrived.arrives_s, nullptr};
    frame.truth = truth_;
    fill(frame);
    processing_.needs.check(frame);
    if (hash_frames_) hash_ = hash_of(arrived.frame, *frame.points);
    renderer.on_frame(frame);
  }
}

void FrameStream::fill(Frame& frame) {
  const int source = source_frame(frame.index);
  if (processing_.changes_points())
    processing_.fill(frame, scenario_.cloud(source),
                     scenario_.fixtures_off(frame.index).value_or(processing_.fixtures.off()));
  else if (frame.index > source && repeated_)
    frame.points = repeated_;
  else
    frame.points = points_of(source);
  if (frame.index > source) repeated_ = frame.points;
}

std::shared_ptr<const NeighbourSearch> FrameStream::points_of(int source) const {
  auto points = scenario_.points(source);
  if (!generate_all_points_ || dynamic_cast<const CloudSearch*>(points.get())) return points;
  return make_search(scenario_.cloud(source));
}

std::uint64_t FrameStream::hash_of(int frame, const NeighbourSearch& points) const {
  const auto* stored = dynamic_cast<const CloudSearch*>(&points);  // else points are computed on demand
  return frame_hash(stored ? stored->cloud() : scenario_.cloud(source_frame(frame)), captured_s(frame));
}

}  // namespace remote_touch
