// A page of a live run sends requests, which are checked, and messages, which are not trusted.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "runners/live/devices/built_in_devices.h"
#include "runners/live/loop/live_run.h"
#include "runners/live/loop/servo.h"
#include "runners/live/view/live_channel.h"

namespace remote_touch {

// Decides from the headers of a request whether the page server may answer it, and says what the user can do
// if not. The secret in the address is checked before.

// host: the value of the header Host. Returns true for 127.0.0.1, localhost and [::1], with any port or none:
// `ssh -L` may forward any port to the server. Another name may be one that a foreign site has pointed to
// 127.0.0.1 (DNS rebinding).
bool is_loopback_host(std::string_view host);

// origin: the value of the header Origin, which names the page that opens a WebSocket. Returns true if that
// page came from this server under the same name and port as the request. Pages of other programs on this
// machine have another port, and are refused.
bool is_own_origin(std::string_view origin, std::string_view host);

// The sentence that a browser shows instead of the page, ending with a line break. status: of HTTP; port: of
// this server.
std::string refusal_text(unsigned status, const std::string& port);

// The messages of a page that shows a live run. They are not trusted: any program on this machine may have
// sent them.

// The page has shown the message of that number, and all before it.
struct PageAcknowledgement {
  std::uint32_t number = 0;
};

// The user of the page asks for the hand and the sliders of another page.
struct HandRequest {};

using PageMessage = std::variant<DeviceState, PageAcknowledgement, ParameterChanges, HandRequest>;

inline constexpr std::size_t kMaxPageMessage = 8 + 16 * ParameterChanges::kMax;  // bytes

// Decodes a message; all numbers are little endian.
// - A hand: 1, three bytes 0, buttons (u32), position in metres and quaternion w x y z (f64); 64 bytes.
// - An acknowledgement: 2, three bytes 0, number (u32); 8 bytes.
// - Changes of parameters: 3, three bytes 0, their count (u32); then for each change its parameter (i32),
//   0 (u32) and value (f64).
// - A request for the hand: 4, three bytes 0, 0 (u32); 8 bytes.
// Returns none for anything else, and for a pose that is not finite or too far away, or whose quaternion is
// not approximately a unit quaternion.
std::optional<PageMessage> page_message(std::string_view bytes);

// The pages that show one live run. LivePages decides which page has the hand, and passes ticks, frames and
// texts to all of them.
//
// The first page has the hand; later pages watch, and may request the hand. When the page with the hand
// closes, the page that has watched longest receives the hand. A page may lose its connection and connect
// again before the server has noticed the loss. It then replaces its own older connection and keeps the hand.
// A page that connects later counts as a new page.

class LivePages {
 public:
  static constexpr std::size_t kMax = 4;  // pages at the same time

  // The same arguments as for LiveChannel.
  LivePages(double haptic_rate_hz, const DevicePlacement& placement, const Kernels& kernels,
            std::shared_ptr<HandPoses> poses, std::shared_ptr<LiveControls> controls, double near_m);

  // The threads of the run call these.
  void take(const LiveTick& tick) noexcept;
  void take(const Frame& frame) noexcept;
  void tell(const LiveTrouble& trouble);
  // The run has ended: sends the reason to every page, also to pages that connect later. Only the first call
  // counts.
  void end(const std::string& why);
  std::string ended() const;  // the reason; empty until the run has ended

  // The server's thread calls these. open() returns the channel for a page, which belongs to the page until
  // close(), or null if is_full(page). page: the name that the page gave itself, at most kMaxName bytes.
  static constexpr std::size_t kMaxName = 32;
  LiveChannel* open(std::string_view page);
  void close(LiveChannel& channel);
  // True if kMax other pages are connected, or if no channel is free. A page that connects again does not
  // count.
  bool is_full(std::string_view page) const;
  // See LiveChannel::receive(). If the message has changed parameters, the other pages receive the new
  // values. A request for the hand from a page that watches is granted, see PageHand::pass_on(); the page
  // that had the hand watches from then on.
  bool receive(LiveChannel& channel, std::string_view bytes);

 private:
  struct Page {
    std::unique_ptr<LiveChannel> channel;
    std::string name;
    bool is_taken = false;
    std::uint64_t came = 0;  // the order in which the pages came
  };
  Page* with_hand();
  bool give_hand(LiveChannel& channel);

  const std::shared_ptr<PageHand> hand_;
  const std::shared_ptr<LiveControls> controls_;
  std::array<Page, 2 * kMax> pages_;  // the older connection of each page may still be there
  std::uint64_t came_ = 0;
  mutable std::mutex mutex_;  // guards the following members
  std::string trouble_;       // the newest message; empty: none
  std::string ended_;
};

}  // namespace remote_touch
