// Reads the messages that a page sends while it shows a live run.
#include "runners/live/loop/live_view.h"

#include <cmath>

#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::page_message {
namespace {

void read(std::string_view bytes) {
  const auto message = remote_touch::page_message(bytes);
  if (!message) return;
  const auto* const hand = std::get_if<DeviceState>(&*message);
  if (!hand) return;
  require(hand->position_W.cwiseAbs().maxCoeff() <= kMaxHandDistance_m, "a hand is near");
  require(std::abs(hand->orientation_W.norm() - 1) < 1e-9, "an orientation is a unit quaternion");
}

const Registered registered("page_message", read);

}  // namespace
}  // namespace remote_touch::fuzz::page_message
