#include "runners/live/view/live_pages.h"

#include <algorithm>
#include <utility>

#include "runners/live/view/page_requests.h"

namespace remote_touch {

LivePages::LivePages(double haptic_rate_hz, const DevicePlacement& placement, const Kernels& kernels,
                     std::shared_ptr<HandPoses> poses, std::shared_ptr<LiveControls> controls, double near_m)
    : hand_(std::make_shared<PageHand>(std::move(poses))), controls_(std::move(controls)) {
  for (Page& page : pages_)
    page.channel =
        std::make_unique<LiveChannel>(haptic_rate_hz, placement, kernels, hand_, controls_, near_m);
}

void LivePages::take(const LiveTick& tick) noexcept {
  for (Page& page : pages_) page.channel->take(tick);
}

void LivePages::take(const Frame& frame) noexcept {
  for (Page& page : pages_) page.channel->take(frame);
}

// A page that connects meanwhile receives the message once, from here or from open(): both hold the mutex.
void LivePages::tell(const LiveTrouble& trouble) {
  const std::lock_guard lock(mutex_);
  trouble_ = trouble_message(trouble);
  for (Page& page : pages_)
    if (page.channel->is_open()) page.channel->tell(trouble_);
}

void LivePages::end(const std::string& why) {
  const std::lock_guard lock(mutex_);
  if (!ended_.empty()) return;
  ended_ = why;
  for (Page& page : pages_)
    if (page.channel->is_open()) page.channel->end(ended_message(why));
}

std::string LivePages::ended() const {
  const std::lock_guard lock(mutex_);
  return ended_;
}

LivePages::Page* LivePages::with_hand() {
  const auto found =
      std::find_if(pages_.begin(), pages_.end(), [](const Page& page) { return page.channel->has_hand(); });
  return found == pages_.end() ? nullptr : &*found;
}

bool LivePages::is_full(std::string_view name) const {
  const auto others = std::count_if(pages_.begin(), pages_.end(), [&](const Page& page) {
    return page.channel->is_open() && page.name != name;
  });
  const auto is_taken = [](const Page& page) { return page.is_taken; };
  return others >= static_cast<std::ptrdiff_t>(kMax) || std::all_of(pages_.begin(), pages_.end(), is_taken);
}

LiveChannel* LivePages::open(std::string_view name) {
  if (is_full(name)) return nullptr;
  // The older connection of the same page is replaced: the page no longer uses it, even if the network has
  // not reported that yet.
  for (Page& page : pages_)
    if (page.channel->is_open() && page.name == name) {
      page.channel->close();
      page.channel->end({});
    }
  const auto page =
      std::find_if(pages_.begin(), pages_.end(), [](const Page& each) { return !each.is_taken; });
  page->name = name, page->came = ++came_;
  const PageRole role = with_hand() ? PageRole::watches : PageRole::hand;
  if (role == PageRole::hand) hand_->pass_on();
  const std::lock_guard lock(mutex_);
  page->channel->open(role, trouble_);
  page->is_taken = true;
  if (!ended_.empty()) page->channel->end(ended_message(ended_));
  return page->channel.get();
}

void LivePages::close(LiveChannel& channel) {
  channel.close();
  Page* next = nullptr;
  for (Page& page : pages_) {
    if (page.channel.get() == &channel) page.is_taken = false;
    if (page.channel->is_open() && (next == nullptr || page.came < next->came)) next = &page;
  }
  if (next != nullptr && with_hand() == nullptr) give_hand(*next->channel);
}

bool LivePages::give_hand(LiveChannel& channel) {
  if (!channel.is_open() || channel.has_hand()) return false;
  if (Page* const before = with_hand()) before->channel->set_role(PageRole::watches);
  hand_->pass_on();
  channel.set_role(PageRole::hand);
  return true;
}

bool LivePages::receive(LiveChannel& channel, std::string_view bytes) {
  if (const auto message = page_message(bytes); message && std::holds_alternative<HandRequest>(*message))
    return give_hand(channel);
  const std::vector<double> before = controls_->values();
  const bool is_message = channel.receive(bytes);
  if (controls_->values() != before)
    for (Page& page : pages_)
      if (page.channel->is_open() && page.channel.get() != &channel) page.channel->tell_parameters();
  return is_message;
}

}  // namespace remote_touch
