#include "runners/live/view/live_channel.h"

#include <utility>

#include "runners/live/view/page_message.h"

namespace remote_touch {

LiveChannel::LiveChannel(double haptic_rate_hz, const DevicePlacement& placement, const Kernels& kernels,
                         std::shared_ptr<PageHand> hand, std::shared_ptr<LiveControls> controls,
                         double near_m)
    : rate_hz_(haptic_rate_hz),
      placement_(placement),
      kernels_(kernels),
      hand_(std::move(hand)),
      controls_(std::move(controls)),
      near_m_(near_m) {}

// Drops the waiting ticks if there is no memory: a page that lacks some ticks is better than a run that ends.
void LiveChannel::take(const LiveTick& tick) noexcept {
  if (!is_open_.load(std::memory_order_relaxed)) return;
  const std::lock_guard lock(mutex_);
  hip_W_ = tick.device.position_W, proxy_W_ = tick.out.proxy_W;
  try {
    if (rows_.length() >= kMaxRows) rows_ = {};
    rows_.append(tick, rate_hz_, placement_);
  } catch (const std::bad_alloc&) {
    rows_ = {};
  }
}

void LiveChannel::take(const Frame& frame) noexcept {
  const std::lock_guard lock(mutex_);
  points_ = frame.points;
  index_ = frame.index;
  frame_is_new_ = true;
}

void LiveChannel::open(PageRole role, const std::string& trouble) {
  const std::lock_guard lock(mutex_);
  rows_ = {};
  frame_is_new_ = points_ != nullptr;
  sent_columns_ = was_frame_ = false;
  sent_ = acknowledged_ = 0;
  role_ = role;
  texts_ = {role_message(role)};
  if (!trouble.empty()) texts_.push_back(trouble);
  if (controls_->has_changed()) texts_.push_back(values_text_ = parameters_message(*controls_, {}));
  is_ended_ = false;
  is_open_ = true;
}

// Only the first call releases buttons: another page may have the hand at the next one.
void LiveChannel::close() {
  if (is_open_.exchange(false) && role_ == PageRole::hand) hand_->release_buttons();
}

// A role that still waits to be sent is dropped, so that pages which take the hand from each other cannot
// fill the queue of a slow page.
void LiveChannel::set_role(PageRole role) {
  role_ = role;
  const std::lock_guard lock(mutex_);
  for (const PageRole any : {PageRole::hand, PageRole::watches}) std::erase(texts_, role_message(any));
  texts_.push_back(role_message(role));
}

// A waiting text has older values. Without this, changes of one page would fill the queue of a slow one.
void LiveChannel::tell_parameters(const std::string& refused) {
  std::string text = parameters_message(*controls_, refused);
  const std::lock_guard lock(mutex_);
  std::erase(texts_, values_text_);
  if (refused.empty()) values_text_ = text;
  texts_.push_back(std::move(text));
}

void LiveChannel::tell(std::string text) {
  const std::lock_guard lock(mutex_);
  texts_.push_back(std::move(text));
}

void LiveChannel::end(std::string last) {
  const std::lock_guard lock(mutex_);
  if (is_ended_) return;
  is_ended_ = true;
  last_ = std::move(last);
}

bool LiveChannel::is_over() {
  const std::lock_guard lock(mutex_);
  return is_ended_ && last_.empty();
}

bool LiveChannel::receive(std::string_view bytes) {
  const auto message = page_message(bytes);
  const auto* acknowledged = message ? std::get_if<PageAcknowledgement>(&*message) : nullptr;
  const bool is_allowed =
      message && (acknowledged ? acknowledged->number - acknowledged_ <= sent_ - acknowledged_ : has_hand());
  if (!is_allowed) return false;
  if (acknowledged) {
    acknowledged_ = acknowledged->number;
  } else if (const auto* changes = std::get_if<ParameterChanges>(&*message)) {
    tell_parameters(controls_->change(*changes));
  } else if (const auto* pose = std::get_if<HandPose>(&*message)) {
    hand_->move(*pose);
  } else {
    return false;  // LivePages handles requests for the hand
  }
  return true;
}

bool LiveChannel::next_text(Message& message) {
  const std::lock_guard lock(mutex_);
  if (is_ended_ && !last_.empty()) {
    message = {std::exchange(last_, {}), true};
    return true;
  }
  if (!sent_columns_ || texts_.empty()) return false;
  message = {std::move(texts_.front()), true};
  texts_.erase(texts_.begin());
  return true;
}

bool LiveChannel::next(Message& message) {
  if (next_text(message)) return true;
  if (sent_ - acknowledged_ >= kMaxInFlight) return false;
  std::shared_ptr<const NeighbourSearch> points;
  std::int32_t index = 0;
  {
    const std::lock_guard lock(mutex_);
    if (rows_.length() == 0) return false;
    // Ticks and frames alternate. Otherwise a page that is slower than the camera would receive frames only,
    // because a new frame is always ready.
    was_frame_ = sent_columns_ && frame_is_new_ && !was_frame_;
    if (was_frame_) points = points_, index = index_, frame_is_new_ = false;
  }
  message = points ? frame_message_of(*points, index) : tick_message();
  return true;
}

LiveChannel::Message LiveChannel::tick_message() {
  LiveRows rows;
  {
    const std::lock_guard lock(mutex_);
    if (!sent_columns_) {
      sent_columns_ = true;
      return {columns_message(rows_.columns()), true};
    }
    std::swap(rows, rows_);
  }
  return {ticks_message(rows.columns(), ++sent_), false};
}

LiveChannel::Message LiveChannel::frame_message_of(const NeighbourSearch& points, std::int32_t index) {
  PointCloud buffer;
  return {frame_message(points.every_point(kernels_, buffer), index, {kMaxPoints, near_hand()}, ++sent_),
          false};
}

NearHand LiveChannel::near_hand() {
  double reach_m = near_m_;
  for (std::size_t i = 0; i < controls_->parameters().size(); ++i)
    if (const LiveParameter& p = controls_->parameters()[i]; p.name == "renderer.r1_m" && p.value > 0)
      reach_m *= controls_->values()[i] / p.value;
  const std::lock_guard lock(mutex_);
  return {hip_W_, proxy_W_, reach_m};
}

}  // namespace remote_touch
