// The pages that show one live run. LivePages decides which page has the hand, and passes ticks, frames and
// texts to all of them.
//
// The first page has the hand; later pages watch, and may request the hand. When the page with the hand
// closes, the page that has watched longest receives the hand. A page may lose its connection and connect
// again before the server has noticed the loss. It then replaces its own older connection and keeps the hand.
// A page that connects later counts as a new page.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "runners/live/loop/live_run.h"
#include "runners/live/view/live_channel.h"

namespace remote_touch {

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
