// Devices and their services, and pages that show a live run.
#include <cmath>
#include <sstream>

#include "runners/live/devices/device_table.h"
#include "runners/live/devices/haply.h"
#include "runners/live/loop/live_view.h"
#include "tests/doubles/simulated_clock.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::live {
namespace {

// Addresses of devices and sensors, SCHEME:PLACE?KEY=VALUE&..., and the address of a Haply service.

void read_address(std::string_view bytes) {
  accepts(bytes, [&] {
    const Uri uri = parse_uri("--device", std::string(bytes));
    const DeviceAddress address(uri.scheme, uri.address, {"force", "rate", "device", "handle", "check"});
    address.word("device", ""), address.choice("force", {"vector", "values"});
    const double rate_hz = address.number("rate", 1000, 100, 8000);
    require(rate_hz >= 100 && rate_hz <= 8000, "a number is in its range");
    const HaplyPlace place = haply_place(address);
    require(!place.host.empty() && !place.port.empty() && place.target.starts_with('/'),
            "a place has host, port and path");
  });
}

const Registered of_address("device_address", read_address);

// The adapter of Haply's Inverse3 with a service that sends anything. Each line is a message, in the order in
// which they are read. An empty line means that no answer comes in time.

class AnyService final : public HaplyLink {
 public:
  AnyService(std::string_view bytes, SimulatedClock& clock) : lines_(std::string(bytes)), clock_(clock) {}
  DeviceFault send(std::string_view, double) noexcept override { return {}; }
  DeviceFault receive(std::string_view& text, double deadline_s) noexcept override {
    if (!std::getline(lines_, line_)) return {"the Haply service closed the connection"};
    text = line_;
    if (!line_.empty()) return {};
    clock_.sleep_until_ns(static_cast<std::int64_t>(1e9 * deadline_s));
    return {"the Haply service does not answer"};
  }
  void cut() noexcept override {}

 private:
  std::istringstream lines_;
  std::string line_;
  SimulatedClock& clock_;
};

void read_service(std::string_view bytes) {
  SimulatedClock clock;
  accepts(bytes, [&] {
    const auto device = open_haply("", clock, [&](const DeviceAddress&, const Clock&, double) {
      return std::make_unique<AnyService>(bytes, clock);
    });
    for (int tick = 0; tick < 20; ++tick) {
      DeviceReading reading;
      if (!device->read(reading))
        require(reading.position_m.allFinite() && reading.orientation.coeffs().allFinite(),
                "a reading is finite");
      device->write({Vec3(0.1 * tick, 0, -1), Vec3::Zero()});
      clock.sleep_until_ns(clock.now_ns() + ms(1));
    }
    device->release();
  });
}

const Registered of_service("haply_device", read_service);

// Messages of Haply's service, as text.

void read_message(std::string_view bytes) {
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

const Registered of_message("haply_message", read_message);

// Reads the messages that a page sends while it shows a live run.

void read_page(std::string_view bytes) {
  const auto message = remote_touch::page_message(bytes);
  if (!message) return;
  const auto* const hand = std::get_if<DeviceState>(&*message);
  if (!hand) return;
  require(hand->position_W.cwiseAbs().maxCoeff() <= kMaxHandDistance_m, "a hand is near");
  require(std::abs(hand->orientation_W.norm() - 1) < 1e-9, "an orientation is a unit quaternion");
}

const Registered of_page("page_message", read_page);

}  // namespace
}  // namespace remote_touch::fuzz::live
