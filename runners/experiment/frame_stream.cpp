#include "runners/experiment/frame_stream.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "analysis/columns/fingerprint.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

// Points that come with another time stamp are another frame.
std::uint64_t frame_hash(const PointCloud& cloud, double captured_s) {
  return mixed(fingerprint(cloud), std::bit_cast<std::uint64_t>(captured_s));
}

void FrameProcessing::fill(Frame& frame, PointCloud cloud, std::uint64_t off) const {
  if (depth) {
    if (!cloud.image)
      throw InputError("depth_pipeline", "this scenario's frames are no depth images; allowed none");
    depth->process(cloud);
  }
  frame.guidance = fixtures.targets(cloud, frame.captured_s);
  fixtures.assign(cloud, frame.captured_s, off);
  frame.points = make_search(std::move(cloud));
}

FrameStream::FrameStream(const Scenario& scenario, FrameProcessing processing, const Delivery& delivery,
                         const NoiseKey& key, bool hash_frames, bool made_points)
    : scenario_(scenario),
      processing_(std::move(processing)),
      delivery_(delivery),
      key_(key),
      hash_frames_(hash_frames),
      made_points_(made_points) {}

bool FrameStream::exists(int frame) const {
  if (frame < scenario_.frame_count()) return true;
  const bool goes_on = processing_.fixtures.changes_with_time() || delivery_.drop_probability > 0;
  return goes_on && !scenario_.ends();
}

// Beyond the last frame the camera goes on at its rate and sees what it saw.
int FrameStream::seen(int frame) const {
  return std::min(frame, scenario_.frame_count() - 1);
}

double FrameStream::captured_s(int frame) const {
  return scenario_.captured_s(seen(frame)) + (frame - seen(frame)) / scenario_.frame_rate_hz();
}

void FrameStream::send(int frame) {
  const auto chance = uniforms(noise_stream(key_, NoiseUse::delivery, static_cast<std::uint32_t>(frame)), 0);
  if (chance[0] < delivery_.drop_probability) return;
  std::optional<double> out_s;  // of the sensor
  if (frame == seen(frame)) out_s = scenario_.arrives_s(frame);
  const double there_s = out_s.value_or(captured_s(frame));
  const OnTheWay sent{there_s + delivery_.latency_s + chance[1] * delivery_.jitter_s, frame};
  const auto after = [](const OnTheWay& a, const OnTheWay& b) { return a.arrives_s < b.arrives_s; };
  on_the_way_.insert(std::upper_bound(on_the_way_.begin(), on_the_way_.end(), sent, after), sent);
}

void FrameStream::deliver_until(double time_s, Renderer& renderer) {
  const double now_s = time_s + kSameTime_s;
  while (exists(next_) && captured_s(next_) + delivery_.latency_s <= now_s) send(next_++);
  while (!on_the_way_.empty() && on_the_way_.front().arrives_s <= now_s) {
    const OnTheWay arrived = on_the_way_.front();
    on_the_way_.erase(on_the_way_.begin());
    Frame frame{arrived.frame, captured_s(arrived.frame), arrived.arrives_s, nullptr};
    fill(frame);
    if (hash_frames_) hash_ = hash_of(arrived.frame, *frame.points);
    renderer.on_frame(frame);
  }
}

void FrameStream::fill(Frame& frame) const {
  if (processing_.changes_points())
    processing_.fill(frame, scenario_.cloud(seen(frame.index)),
                     scenario_.fixtures_off(frame.index).value_or(processing_.fixtures.off()));
  else
    frame.points = scenario_.points(seen(frame.index));
  if (made_points_ && !dynamic_cast<const CloudSearch*>(frame.points.get()))
    frame.points = make_search(scenario_.cloud(seen(frame.index)));
}

std::uint64_t FrameStream::hash_of(int frame, const NeighbourSearch& points) const {
  const auto* stored = dynamic_cast<const CloudSearch*>(&points);  // else points are made when asked for
  return frame_hash(stored ? stored->cloud() : scenario_.cloud(seen(frame)), captured_s(frame));
}

}  // namespace remote_touch
