// A recorded live session as an experiment: its frames as a scenario, its hand as a trajectory.
#pragma once

#include <memory>
#include <string>

#include "core/parameters/parameter.h"
#include "runners/experiment/hand/trajectory.h"
#include "runners/experiment/sessions/sensor_frame.h"
#include "runners/experiment/sessions/session_file.h"
#include "scenarios/recordings/recording.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

struct SessionSettings {
  std::string path;
};

Parameters parameters(SessionSettings& s);
std::string validate(const SessionSettings& s);
InputPart input_files(const SessionSettings& s);

// The frames as the sensor sent them, at the times when the live renderer received them.
class SessionScene final : public Scenario {
 public:
  using Settings = SessionSettings;
  // Throws InputError when the session cannot be read.
  SessionScene(const Settings& settings, const NoiseKey& key, const Kernels& kernels);

  double frame_rate_hz() const override { return session_.view().frame_rate_hz; }
  int frame_count() const override { return static_cast<int>(session_.frame_count()); }
  double captured_s(int frame) const override { return session_.captured_s(static_cast<std::size_t>(frame)); }
  bool ends() const override { return true; }
  PointCloud cloud(int frame) const override;
  // NaN: the truth is not known.
  double signed_distance(const Vec3& p_W, double time_s) const override;
  FrameDelivery delivery(int frame) const override {
    const auto i = static_cast<std::size_t>(frame);
    return {arrives_s_[i], session_.fixtures_off(i)};
  }
  std::string input() const override;
  // Returns notes if this run did not use all frames that the live renderer received, or if the recording was
  // interrupted.
  std::vector<Note> input_notes() const override;

 private:
  SensorFrame read(std::size_t frame) const;

  const std::string path_;
  const SessionReader session_;
  std::vector<double> arrives_s_;  // infinite if the renderer never received the frame
  mutable SensedPoints sensed_;    // points of the frames that were read; each frame counts once
  mutable std::vector<bool> is_read_;
};

// Returns the state of the session's device at the nearest tick. If that tick was missed, it is the state at
// the tick before.
class SessionHand final : public Trajectory {
 public:
  using Settings = SessionSettings;
  SessionHand(const Settings& settings, const Scenario& scenario);

  DeviceState at(double time_s) const override;
  double duration_s() const override;
  bool is_missed(double time_s) const override;

 private:
  std::size_t tick_at(double time_s) const;

  const SessionReader session_;
};

// Returns the experiment of a session, as JSON: the experiment that was run, with the recorded frames and
// hand.
std::string session_experiment(const std::string& path);
std::string session_experiment(const SessionReader& session, const std::string& path);

}  // namespace remote_touch
