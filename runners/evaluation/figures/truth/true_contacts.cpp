#include "runners/evaluation/figures/truth/true_contacts.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "runners/experiment/catalog/frame_stream.h"

namespace remote_touch {

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
    const double renderer_m = window.measured_distance(contacts_W[frame], time_s);
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
