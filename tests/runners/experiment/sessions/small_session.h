// A live session of a few ticks and frames, written as the live loop writes one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runners/experiment/sessions/session_file.h"

namespace remote_touch {

struct SmallSession {
  // 3 x 2 pixels.
  SensorView view{{3, 2, 100, 110, 1.25, 0.5}, 0.0005, 30, false, RigidTransform::Identity()};
  RigidTransform registered = RigidTransform::Identity();
  std::string config = R"({"haptic_rate_hz": 1000})";
  std::vector<SessionTick> ticks;
  std::vector<SensorFrame> frames;
  std::vector<double> captured_s;
  std::vector<std::uint64_t> fixtures_off;

  void add_tick(std::int64_t number, int taken = -1) {
    SessionTick tick;
    tick.number = number, tick.taken = taken;
    tick.device.position_W = Vec3(static_cast<double>(number), 0, -0.5);
    ticks.push_back(tick);
  }

  // Adds a frame in which every pixel is one unit farther than the one before.
  void add_frame(int number, double at_s, std::uint16_t first_depth = 500, std::uint64_t off = 0) {
    SensorFrame frame;
    frame.number = number;
    for (int i = 0; i < view.camera.width * view.camera.height; ++i) {
      frame.depth.push_back(static_cast<std::uint16_t>(first_depth + i));
      if (view.has_colour) frame.colour.push_back(0xff0000u + static_cast<std::uint32_t>(i));
    }
    frames.push_back(frame), captured_s.push_back(at_s), fixtures_off.push_back(off);
  }

  void fill(SessionWriter& writer) const {
    for (std::size_t i = 0; i < frames.size(); ++i) writer.append(frames[i], captured_s[i], fixtures_off[i]);
    for (const SessionTick& tick : ticks) writer.append(tick);
  }

  std::string write(const std::filesystem::path& file) const {
    SessionWriter writer(file, view, registered, {{"config", config}});
    fill(writer);
    writer.finish();
    return file.string();
  }
};

}  // namespace remote_touch
