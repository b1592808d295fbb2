#include "runners/live/view/page_hand.h"

namespace remote_touch {

void PageHand::publish() {
  poses_->back() = motion_;
  poses_->publish();
}

void PageHand::pass_on() {
  page_start_.reset();
  motion_ = {{}, {}, motion_.stops + 1};
  publish();
}

void PageHand::move(const HandPose& of_page) {
  if (!page_start_) page_start_ = of_page;
  motion_.from = *page_start_;
  motion_.to = of_page;
  publish();
}

void PageHand::release_buttons() {
  if (motion_.to.buttons == 0) return;
  motion_.to.buttons = 0;
  publish();
}

}  // namespace remote_touch
