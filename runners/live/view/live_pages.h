// The pages that show one live run: which of them has the hand, and what all of them get.
//
// The first page has the hand; those that come later watch. When the page with the hand closes, the page that
// has watched longest gets it. A page that connects again before the server has noticed the loss takes the
// place of its own older connection, and keeps the hand; later it is a new page.
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "runners/live/loop/live_trouble.h"
#include "runners/live/view/live_channel.h"

namespace remote_touch {

class LivePages {
 public:
  static constexpr std::size_t kMax = 4;  // pages at the same time

  // The same arguments as for LiveChannel.
  LivePages(double haptic_rate_hz, const DevicePlacement& placement, const Kernels& kernels,
            const std::shared_ptr<HandPoses>& poses, std::shared_ptr<LiveControls> controls);

  // The threads of the run call these.
  void take(const LiveTick& tick) noexcept;
  void take(const Frame& frame) noexcept;
  void tell(const LiveTrouble& trouble);
  // The run has ended: every page gets the reason, now or when it asks. Only the first call counts.
  void end(const std::string& why);
  std::string ended() const;  // why; empty: it goes on
  std::uint64_t refused() const;

  // The server's thread calls these. page: the name that the page gave itself, at most kMaxName bytes. Null:
  // kMax pages are connected. The channel belongs to this page until close().
  static constexpr std::size_t kMaxName = 32;
  LiveChannel* open(std::string_view page);
  void close(LiveChannel& channel);
  bool is_full() const;
  // See LiveChannel::receive(); other pages get the parameters that have changed.
  bool receive(LiveChannel& channel, std::string_view bytes);

 private:
  struct Page {
    std::unique_ptr<LiveChannel> channel;
    std::string name;
    bool is_taken = false;
    std::uint64_t came = 0;  // the order in which the pages came
  };
  Page* free_page();
  Page* with_hand();

  const std::shared_ptr<LiveControls> controls_;
  std::array<Page, kMax> pages_;
  std::uint64_t came_ = 0;
  mutable std::mutex mutex_;  // of the following
  std::string trouble_;       // the newest message; empty: none
  std::string ended_;
};

}  // namespace remote_touch
