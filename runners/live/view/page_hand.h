// Passes the hand of the pages to the device browser:. One page has the hand at a time, and the hand must not
// jump when another page receives it: a jump of the hand is a jump of the force.
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "runners/live/devices/browser_device.h"

namespace remote_touch {

// Poses are in the world frame, lengths in metres. The safety gate and the speed limit of BrowserDevice apply
// as well.
class PageHand {
 public:
  explicit PageHand(std::shared_ptr<HandPoses> poses) : poses_(std::move(poses)) {}

  // The state of the device at the newest tick. Any thread may call it.
  void take(const DeviceState& now);

  // The server's thread calls the following functions.
  // A page receives the hand. If a page has moved the hand before, this stops it where the newest tick has
  // it, with no button pressed. The hand stays there until the page moves it.
  void pass_on();
  // A pose from the page that has the hand. The first one after pass_on() only says where that page begins
  // to count: the hand does not move with it. Each later one moves the hand from where it was stopped by the
  // page's own motion since the first. So no page can make the hand jump by a wrong idea of where it is.
  void move(const HandPose& of_page);
  // Releases the buttons, because the user can no longer do so.
  void release_buttons();

 private:
  void publish(const HandPose& pose);
  std::optional<HandPose> newest();

  const std::shared_ptr<HandPoses> poses_;
  std::mutex mutex_;
  std::optional<HandPose> newest_;  // pose at the newest tick; none before the first tick
  // Members used only by the server's thread.
  std::optional<HandPose> sent_;   // the newest pose published
  std::optional<HandPose> start_;  // pose of the hand at which the page with the hand began
  std::optional<HandPose> begin_;  // the first pose that this page sent
};

}  // namespace remote_touch
