// Haply Inverse3, through the WebSocket of its Inverse service. Tested against a simulated service only.
//
// The address is ws://HOST:PORT, by default ws://127.0.0.1:10001, and settings:
//   force=vector|values  key of the force in a command: `vector` for version 3.5, `values` for 3.1 to 3.4
//   rate=HZ              rate of the loop, 100 to 8000, by default 1000
//   device=ID handle=ID  the ones to use if there are several; by default the first of the inventory
//   check=on|off         on, the default: read() returns a fault if the force that the service reports does
//                        not follow the commands for 50 ms
//
// The service sends one state for each command and measures it when the command arrives. So the state that a
// tick reads is one period old; a higher rate makes it newer.
//
// The device senses three axes, or six with a handle (VerseGrip). The buttons of the handle are the lowest
// bits. The service reports no angular velocity; it stays 0. The axes of the handle are converted like those
// of the service: its orientation (w, x, y, z) = (1, 0, 0, 0) is the identity here too.
//
// read() ends within 7 ms and write() within 2.5 ms, whatever the service does. They allocate nothing and
// take no lock; the socket is read and written in the tick. A late service causes faults until it answers;
// after any other fault of the connection the device must be opened again.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/points/vector.h"
#include "runners/live/devices/device_table.h"
#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

// The WebSocket connection to Haply's Inverse service. Compiled in if Boost's headers are installed (build
// option REMOTE_TOUCH_HAPLY).
class HaplyLink {
 public:
  virtual ~HaplyLink() = default;

  // send() and receive() return by the deadline, a time of the clock in seconds. receive() returns up to 1 ms
  // later if a message has begun to arrive by then. They allocate nothing once the first command has been
  // sent. If the service is only late, a later receive() may still return the message. After any other fault
  // the link cannot be used any more.
  virtual DeviceFault send(std::string_view text, double deadline_s) noexcept = 0;
  // text: valid until the next call.
  virtual DeviceFault receive(std::string_view& text, double deadline_s) noexcept = 0;

  // Ends the connection: nothing is sent or received any more, and calls in progress return. Any thread may
  // call it.
  virtual void cut() noexcept = 0;
};

bool haply_link_is_compiled_in();

// place of the address: ws://HOST[:PORT][/PATH], by default ws://127.0.0.1:10001. Throws InputError.
std::unique_ptr<HaplyLink> open_haply_link(const DeviceAddress& address, const Clock& clock,
                                           double deadline_s);

// The host, port and target at which Haply's service listens.
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

using HaplyLinkOpener =
    std::function<std::unique_ptr<HaplyLink>(const DeviceAddress&, const Clock&, double deadline_s)>;

// Throws InputError. Sends a command with zero force, because the service then sends a first state.
//
// release() of the device waits at most 5 ms until no thread is in read() or write(). It then sends such a
// command too and waits at most 20 ms for the answer. In every case it ends the connection: from then on no
// command of this process reaches the service. According to its documentation the service lets the device
// idle when commands stop.
std::unique_ptr<HapticDevice> open_haply(const std::string& address, Clock& clock,
                                         const HaplyLinkOpener& open_link = open_haply_link);

// Queries the service at the default address; waits at most 0.3 s.
Availability haply_availability(const Clock& clock);

}  // namespace remote_touch
