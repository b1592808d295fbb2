// The adapter of Haply's Inverse3 with a service that sends anything. Each line is a message, in the order in
// which they are read. An empty line means that no answer comes in time.
#include <sstream>

#include "runners/live/devices/haply.h"
#include "tests/doubles/simulated_clock.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::haply_device {
namespace {

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

void read(std::string_view bytes) {
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

const Registered registered("haply_device", read);

}  // namespace
}  // namespace remote_touch::fuzz::haply_device
