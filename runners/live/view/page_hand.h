// Passes the hand of the pages to the device browser:. One page has the hand at a time, and the hand must not
// jump when another page receives it: a jump of the hand is a jump of the force.
#pragma once

#include <memory>
#include <optional>

#include "runners/live/devices/browser_device.h"

namespace remote_touch {

// Poses are in the world frame, lengths in metres. The safety gate and the speed limit of BrowserDevice apply
// as well. Only the server's thread calls the functions.
class PageHand {
 public:
  explicit PageHand(std::shared_ptr<HandPoses> poses) : poses_(std::move(poses)) {}

  // A page receives the hand. BrowserDevice stops the hand in its next tick, with no button pressed. The hand
  // stays there until the page moves it.
  void pass_on();
  // A pose from the page that has the hand. The first pose after pass_on() is the reference and does not move
  // the hand. Each later pose displaces the hand, from where it was stopped, by the motion of the page since
  // the reference. So no page can make the hand jump by a wrong idea of where it is.
  void move(const HandPose& of_page);
  // Releases the buttons, because the user can no longer do so.
  void release_buttons();

 private:
  void publish();

  const std::shared_ptr<HandPoses> poses_;
  std::optional<HandPose> page_start_;  // the first pose of the page that has the hand
  HandMotion motion_;                   // the newest motion published
};

}  // namespace remote_touch
