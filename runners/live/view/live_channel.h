// Connects a live run with one page that shows it: queues the messages for the page, and handles the messages
// from the page. The run never waits for the page. A slow page receives only the newest frame, and all
// waiting ticks are dropped when there are too many. LivePages has the channels of all pages of a run.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/rendering/frame.h"
#include "runners/live/loop/live_controls.h"
#include "runners/live/loop/servo.h"
#include "runners/live/view/live_rows.h"
#include "runners/live/view/page_hand.h"
#include "runners/live/view/view_messages.h"

namespace remote_touch {

class LiveChannel {
 public:
  static constexpr std::size_t kMaxRows = 5000;      // ticks that may wait; with more, all are dropped
  static constexpr std::size_t kMaxPoints = 300000;  // most points of a frame
  static constexpr std::uint32_t kMaxInFlight = 2;   // messages that the page has not acknowledged

  // placement: that of the device in the world. near_m: points within this distance of the HIP or the proxy,
  // m, are always sent. It grows with the contact radius when the user changes that.
  LiveChannel(double haptic_rate_hz, const DevicePlacement& placement, const Kernels& kernels,
              std::shared_ptr<PageHand> hand, std::shared_ptr<LiveControls> controls, double near_m);

  // The threads of the run call these.
  void take(const LiveTick& tick) noexcept;
  void take(const Frame& frame) noexcept;

  // open(): a page has connected, and receives everything from now on. close(): the page has disconnected.
  // The server's thread calls both. `trouble`: the newest trouble_message(); empty if there was none yet.
  void open(PageRole role = PageRole::hand, const std::string& trouble = {});
  void close();
  // Gives the hand to the page, or takes it away, and sends the page its role.
  void set_role(PageRole role);
  // Sends the parameters to the page, and why changes from it were refused. A text of parameters that still
  // waits is dropped, unless it states a refusal.
  void tell_parameters(const std::string& refused = {});
  bool is_open() const { return is_open_; }
  bool has_hand() const { return is_open_ && role_ == PageRole::hand; }
  // tell(): queues a text for the page, see view_messages.h. end(): queues the last text; the server closes
  // the connection after it, or at once if the text is empty. is_over(): true if the connection is to be
  // closed. Any thread may call them.
  void tell(std::string text);
  void end(std::string last);
  bool is_over();
  // Handles a message from the page. Returns false if it is malformed or if this page may not send it.
  bool receive(std::string_view bytes);
  // Stores the next message for the page in `message`. Returns false if there is none now. Texts are JSON,
  // see view_messages.h. The columns are sent before all other texts; only the text of end() may come
  // earlier.
  struct Message {
    std::string bytes;
    bool is_text = false;
  };
  bool next(Message& message);

 private:
  bool next_text(Message& message);
  Message tick_message();
  Message frame_message_of(const NeighbourSearch& points, std::int32_t index);
  NearHand near_hand();

  const double rate_hz_;
  const DevicePlacement placement_;
  const Kernels& kernels_;
  const std::shared_ptr<PageHand> hand_;
  const std::shared_ptr<LiveControls> controls_;
  const double near_m_;
  std::atomic<bool> is_open_ = false;
  std::mutex mutex_;
  LiveRows rows_;                                       // ticks since the last message
  Vec3 hip_W_ = Vec3::Zero(), proxy_W_ = Vec3::Zero();  // at the newest tick
  std::shared_ptr<const NeighbourSearch> points_;       // points of the newest frame
  std::int32_t index_ = 0;
  bool frame_is_new_ = false;
  std::vector<std::string> texts_;  // texts that wait to be sent
  std::string values_text_;         // the newest text of parameters without a refusal; may be among texts_
  std::string last_;                // last text; waits to be sent when is_ended_
  bool is_ended_ = false;
  // Members used only by the server's thread.
  PageRole role_ = PageRole::hand;
  bool sent_columns_ = false, was_frame_ = false;  // was_frame_: the last message was a frame
  std::uint32_t sent_ = 0, acknowledged_ = 0;
};

}  // namespace remote_touch
