// Messages of Haply's service, as text.
#include "runners/live/devices/haply.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::haply_message {
namespace {

void read(std::string_view bytes) {
  HaplyMessage message;
  if (!read_haply_message(bytes, "", "", message)) return;
  if (message.device) {
    for (const auto& v :
         {message.device->position_m, message.device->velocity_m_per_s, message.device->force_N})
      require(!v || v->allFinite(), "a state has finite numbers");
    HaplyForceCommand command;
    if (command.set_device(message.device->id, HaplyForceKey::vector))
      require(!command.text(Vec3(-1e-300, 1e300, 1.0 / 3)).empty(), "a device can be commanded");
  }
  if (message.handle && message.handle->orientation)
    require(message.handle->orientation->allFinite(), "an orientation is finite");
}

const Registered registered("haply_message", read);

}  // namespace
}  // namespace remote_touch::fuzz::haply_message
