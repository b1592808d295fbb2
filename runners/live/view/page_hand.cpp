#include "runners/live/view/page_hand.h"

#include "runners/live/view/page_message.h"

namespace remote_touch {

void PageHand::take(const DeviceState& now) {
  const std::lock_guard lock(mutex_);
  newest_ = HandPose{now.position_W, now.orientation_W, 0};
}

std::optional<HandPose> PageHand::newest() {
  const std::lock_guard lock(mutex_);
  return newest_;
}

void PageHand::publish(const HandPose& pose) {
  sent_ = pose;
  poses_->back() = pose;
  poses_->publish();
}

void PageHand::pass_on() {
  begin_.reset();
  start_ = newest();
  if (start_ && sent_) publish(*start_);
}

void PageHand::move(const HandPose& of_page) {
  if (!begin_) begin_ = of_page;
  if (!start_) start_ = newest().value_or(of_page);
  HandPose pose = of_page;
  pose.position_W = (start_->position_W + of_page.position_W - begin_->position_W)
                        .cwiseMax(-kMaxHandDistance_m)
                        .cwiseMin(kMaxHandDistance_m);
  pose.orientation_W =
      (of_page.orientation_W * begin_->orientation_W.conjugate() * start_->orientation_W).normalized();
  publish(pose);
}

void PageHand::release_buttons() {
  if (!sent_ || sent_->buttons == 0) return;
  HandPose pose = *sent_;
  pose.buttons = 0;
  publish(pose);
}

}  // namespace remote_touch
