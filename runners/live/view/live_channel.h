// Between a live run and the page that shows it: what is to be sent, and what came. The run never waits for
// the page: of frames the page gets the newest only, of ticks those of the last seconds.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "core/kernels/kernels.h"
#include "core/rendering/frame.h"
#include "runners/live/devices/browser_device.h"
#include "runners/live/loop/live_controls.h"
#include "runners/live/loop/servo.h"
#include "runners/live/view/live_rows.h"

namespace remote_touch {

class LiveChannel {
 public:
  static constexpr std::size_t kMaxRows = 5000;      // that wait for a page; older ones are let go
  static constexpr std::size_t kMaxPoints = 300000;  // of a frame
  static constexpr std::uint32_t kMaxInFlight = 2;   // messages that the page has not acknowledged

  // placement: of the device in the world.
  LiveChannel(double haptic_rate_hz, const DevicePlacement& placement, const Kernels& kernels,
              std::shared_ptr<HandPoses> poses, std::shared_ptr<LiveControls> controls);

  // From the threads of the run.
  void take(const LiveTick& tick) noexcept;
  void take(const Frame& frame) noexcept;

  // From the server's thread. A page has come, or gone: it gets everything from now on.
  void open();
  void close();
  // False: not a message of a page; ignored and counted.
  bool receive(std::string_view bytes);
  // The next message, or none now. Text: the first one, and an answer to changes of parameters.
  struct Message {
    std::string bytes;
    bool is_text = false;
  };
  bool next(Message& message);
  std::uint64_t refused() const { return refused_; }

 private:
  Message tick_message();
  Message frame_message_of(const NeighbourSearch& points, std::int32_t index);

  const double rate_hz_;
  const DevicePlacement placement_;
  const Kernels& kernels_;
  const std::shared_ptr<HandPoses> poses_;
  const std::shared_ptr<LiveControls> controls_;
  std::atomic<bool> is_open_ = false;
  std::mutex mutex_;
  LiveRows rows_;                                  // since the last message
  std::shared_ptr<const NeighbourSearch> points_;  // of the newest frame
  std::int32_t index_ = 0;
  bool frame_is_new_ = false;
  // Of the server's thread.
  bool sent_columns_ = false, was_frame_ = false;  // the last message
  HandPose hand_;                                  // the newest
  std::string answer_;                             // to be sent; empty: none
  std::uint32_t sent_ = 0, acknowledged_ = 0;
  std::uint64_t refused_ = 0;
};

}  // namespace remote_touch
