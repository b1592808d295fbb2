// The host, port and target at which Haply's service listens.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/points/vector.h"
#include "runners/live/devices/device_address.h"

namespace remote_touch {

struct HaplyPlace {
  std::string host = "127.0.0.1", port = "10001", target = "/";

  // Returns HOST:PORT, with an IPv6 address in brackets, as in an address of the Web.
  std::string authority() const;
};

// place of the address: ws://HOST[:PORT][/PATH], or nothing. Throws InputError.
HaplyPlace haply_place(const DeviceAddress& address);

// The messages between Haply's Inverse service and its client, as JSON text: on connecting the service sends
// an inventory, and after that one state for each command. Both are read in the same way. All values are in
// the service's frame and units: x to the right, y away from the user, z up; m, m/s, N. Nothing here
// allocates.

// State of an Inverse3 from one message. The texts are views into the message.
struct HaplyDeviceState {
  std::string_view id;
  // Axes of this connection, in the inventory only; "XYZ" if they are the service's own.
  std::string_view basis;
  std::optional<Vec3> position_m, velocity_m_per_s;
  std::optional<Vec3> force_N;  // force that the service reports as commanded now
};

// State of the handle on the Inverse3, from one message.
struct HaplyHandleState {
  std::string_view id;
  std::optional<Eigen::Vector4d> orientation;  // x, y, z, w as sent
  std::uint32_t buttons = 0;                   // a, b and c; a wired handle has only a
};

struct HaplyMessage {
  std::optional<HaplyDeviceState> device;
  std::optional<HaplyHandleState> handle;
};

// Reads the first device and the first handle, or those with these ids. Returns false if the text is not a
// message of the service, for instance because a value that is read is not finite.
bool read_haply_message(std::string_view text, std::string_view device_id, std::string_view handle_id,
                        HaplyMessage& message) noexcept;

// Key of the force in a command: "vector" according to the documentation of 3.5; clients written for 3.1 to
// 3.4 send "values".
enum class HaplyForceKey { vector, values };

// The command that sets the force.
class HaplyForceCommand {
 public:
  // Returns false if the id cannot be written into a command.
  bool set_device(std::string_view id, HaplyForceKey key) noexcept;
  // Returns the command as text, valid until the next call. force_N: finite.
  std::string_view text(const Vec3& force_N) noexcept;

 private:
  void append(std::string_view text) noexcept;

  std::array<char, 512> text_{};
  std::size_t head_ = 0, size_ = 0;  // length of the part before the numbers, and total length
};

}  // namespace remote_touch
