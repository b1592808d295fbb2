// Addresses of devices and sensors, SCHEME:PLACE?KEY=VALUE&..., and the address of a Haply service.
#include "runners/live/devices/device_table.h"

#include "runners/live/devices/haply.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::device_address {
namespace {

void read(std::string_view bytes) {
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

const Registered registered("device_address", read);

}  // namespace
}  // namespace remote_touch::fuzz::device_address
