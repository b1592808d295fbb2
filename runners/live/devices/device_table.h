// Every haptic device that --device can name: addresses and connections, the devices without hardware, the
// functions that open the others, and a table with one line each.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/hand/simulated_hand.h"
#include "runners/experiment/hand/trajectory.h"
#include "runners/libraries/shared_library.h"
#include "runners/live/devices/clock.h"
#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

// The name of a sensor or a device: "scheme:address".
struct Uri {
  std::string scheme, address;  // the address may be empty
};

// Throws InputError if the text has no scheme or no colon. flag: "--depth" or "--device".
Uri parse_uri(const std::string& flag, const std::string& text);

// Returns the entry of that scheme. Throws InputError, which lists an example of each entry, if there is
// none.
template <class Entry>
const Entry& find_scheme(std::span<const Entry> entries, const std::string& flag, const Uri& uri) {
  std::string known;
  for (const Entry& entry : entries) {
    if (uri.scheme == entry.scheme) return entry;
    known += (known.empty() ? "" : ", ") + std::string(entry.example);
  }
  throw InputError(flag + " " + uri.scheme + ":" + uri.address, "expected " + known);
}

// Returns the words, separated by commas, for messages.
std::string list_of(const std::vector<std::string>& words);

// The address of a device as the user writes it, "haply:ws://127.0.0.1:10001?force=values&rate=2000": a
// scheme, a place and settings. choice() and number() throw InputError for a value that is not allowed.
class DeviceAddress {
 public:
  // address: without the scheme. Throws InputError if a setting is unknown, has no value or is given twice.
  DeviceAddress(const std::string& scheme, const std::string& address, const std::vector<std::string>& known);

  const std::string& place() const { return place_; }  // empty if the user gave none

  bool has(const std::string& key) const { return settings_.count(key) > 0; }
  std::string word(const std::string& key, const std::string& otherwise) const;
  // Returns the value of the setting, which must be one of `allowed`. Returns the first of them if the
  // setting is not given.
  std::string choice(const std::string& key, const std::vector<std::string>& allowed) const;
  double number(const std::string& key, double otherwise, double min, double max) const;

  InputError refusal(const std::string& problem) const;

 private:
  std::string written_, place_;
  std::map<std::string, std::string> settings_;
};

// A connected stream socket. No call waits beyond its deadline, which is a time of the socket's clock in
// seconds. A transfer that is possible without waiting is made even after the deadline. The operating system
// does the waiting.
class DeadlineSocket {
 public:
  struct Transfer {
    std::size_t bytes = 0;
    int error = 0;  // an errno value; ETIMEDOUT at the deadline, ECONNRESET when the peer has closed
  };

  explicit DeadlineSocket(const Clock& clock) : clock_(clock) {}
  ~DeadlineSocket();
  DeadlineSocket(const DeadlineSocket&) = delete;
  DeadlineSocket& operator=(const DeadlineSocket&) = delete;

  // Returns the reason why it could not connect; an empty text on success. Resolving a name may take longer
  // than the deadline. Small messages to a host are sent at once (TCP_NODELAY).
  std::string connect_to_host(const std::string& host, const std::string& port, double deadline_s);
  std::string connect_to_path(const std::string& path, double deadline_s);

  // Reads the bytes that have arrived, without waiting. The error is EAGAIN if none have arrived.
  Transfer read_ready(void* data, std::size_t size) noexcept;
  // Returns 0 if there is something to read, or if the stream has ended; else an errno value.
  int wait_readable(double deadline_s) noexcept;
  Transfer read_some(void* data, std::size_t size, double deadline_s) noexcept;
  Transfer write_some(const void* data, std::size_t size, double deadline_s) noexcept;

  // Shuts the connection down: nothing is sent or received any more, and calls in progress return. Any thread
  // may call it while this object exists.
  void cut() noexcept;

 private:
  int wait(short events, double deadline_s) noexcept;
  int connect_within(const void* address, unsigned size, double deadline_s) noexcept;
  void close() noexcept;

  const Clock& clock_;
  int handle_ = -1;
};

// Devices without hardware: a simulated hand, and a hand that someone moves in a page.

// A device that a script moves, or a simulated operator who follows the script and feels its force. Follows
// its clock: the hand also moves during ticks that were missed, in steps of its own rate. Its time starts at
// start_at(), or else with run().
class SimulatedDevice final : public HapticDevice {
 public:
  // placement: that of the loop. It is used here in the inverse direction.
  SimulatedDevice(std::shared_ptr<const Trajectory> script, const SimulatedHand& hand,
                  const DevicePlacement& placement, double rate_hz, Clock& clock);

  void start_at(std::int64_t start_ns) override { start_s_ = 1e-9 * static_cast<double>(start_ns); }
  // Rethrows the exception of the script after the loop has ended, such as an InputError for an unusable
  // frame.
  void run(const DeviceTick& tick) override;
  // Returns a fault, from then on in every call, if the script throws.
  DeviceFault read(DeviceReading& reading) noexcept override;
  DeviceFault write(const Wrench& wrench) noexcept override;
  void release() noexcept override { armed_.store(false, std::memory_order_relaxed); }
  bool rearm() noexcept override {
    armed_.store(true, std::memory_order_relaxed);
    return true;
  }

 private:
  void move_to_now();

  // The largest number of steps of one tick that the hand makes in one read(). The earlier part of a longer
  // pause is covered by one longer step before them.
  static constexpr int kMaxTicksAtOnce = 200;

  const std::shared_ptr<const Trajectory> script_;
  SimulatedHand hand_;
  const DevicePlacement placement_;
  std::optional<double> start_s_;  // time of the clock at the start
  long long ticks_ = 0;
  DeviceState state_;
  DeviceReading last_;
  std::exception_ptr failure_;  // exception that the script threw
  DeviceFault fault_;           // its text is in failure_
  std::atomic<bool> armed_ = true;
};

inline constexpr double kMaxHandDistance_m = 10;  // limit of the hand of a page, along each axis

// The motion that a page requests: by `to` relative to `from`, from where the hand was stopped. The buttons
// are those of `to`. When `stops` has changed, the tick that reads it stops the hand where it is then,
// because only the loop knows the present place.
struct HandMotion {
  DeviceState from, to;
  std::uint32_t stops = 0;
};

// Passes the newest motion from the thread of the page to the haptic loop.
using HandPoses = TripleBuffer<HandMotion>;

// A hand without a haptic device: someone moves it with the mouse in a page of the viewer. Input only, six
// axes, no motors.
//
// A page sends about sixty poses a second, and the loop needs one in each tick. The position therefore
// follows the newest pose as a critically damped spring would, and the orientation approaches it
// exponentially. Both lag by about 30 ms, and neither is faster than kMaxSpeed_m_per_s and
// kMaxTurning_rad_per_s.
class BrowserDevice final : public HapticDevice {
 public:
  static constexpr double kNaturalFrequency_rad_per_s = 60;  // natural frequency of the spring
  static constexpr double kMaxSpeed_m_per_s = 1;  // a third of what the safety gate allows by default
  static constexpr double kMaxTurning_rad_per_s = 6;

  // start: the state of the hand until the page moves it. placement: must describe the same pose and motion
  // scale of the device as the placement of the loop.
  BrowserDevice(std::shared_ptr<HandPoses> poses, const DeviceState& start, const DevicePlacement& placement,
                double rate_hz, Clock& clock);

  void run(const DeviceTick& tick) override;
  DeviceFault read(DeviceReading& reading) noexcept override;
  DeviceFault write(const Wrench&) noexcept override { return {}; }
  void release() noexcept override {}
  bool rearm() noexcept override { return true; }

 private:
  void request(const HandMotion& motion);
  void follow(double interval_s);
  void turn(double interval_s);

  // The largest number of steps in one read(). The hand does not move in the earlier part of a longer pause.
  static constexpr int kMaxTicksAtOnce = 200;

  const std::shared_ptr<HandPoses> poses_;
  const DevicePlacement placement_;
  DeviceState stopped_, wanted_;
  std::uint32_t stops_ = 0;
  DeviceState now_;
  Vec3 velocity_m_per_s_ = Vec3::Zero();
  double start_s_ = 0;
  long long ticks_ = 0;
  DeviceReading last_;
};

// The adapters of the other devices except Haply's, one source each. open_...() opens a device; it throws
// InputError, which says what is missing. ..._availability() says whether there is one. The adapters of
// vendors' libraries are written from their documentation and tested with test doubles, never with a device.

// Force Dimension's omega, sigma, delta and lambda and Novint's Falcon, through the vendor's DHD library.
// address: the number of the device among those connected; "" is 0.
std::unique_ptr<HapticDevice> open_force_dimension(const std::string& address, Clock& clock);
Availability force_dimension_availability();

// Touch, Touch X and the Phantoms before them, such as the Omni of 4.3 and 6.3, through the HD library of the
// vendor's OpenHaptics. address: the name that the device has in the vendor's setup; "" is "Default Device".
//
// The vendor's scheduler drives run(). If it does not start, or stops calling, read() returns a fault to the
// tick; release() reaches the device even if a callback hangs.
std::unique_ptr<HapticDevice> open_open_haptics(const std::string& address, Clock& clock);
// Checks the library only: the library finds devices only when one is opened.
Availability open_haptics_availability();

// Entact's W5D, the device of 7.5, and W7D, through the vendor's EntactAPI. address: network address of the
// device, "192.168.1.144". If it is empty, the network is queried and the first device that answers is
// opened. A device that is not homed must be held in its calibration position.
//
// Two things differ from the contract of HapticDevice. First, the device reports its pose only while its
// motors are on, and the pose is that at the last force command. So the first read() switches the motors on
// with zero force, and each reading is one tick old. Second, a call that is lost in the network waits for as
// long as the vendor's library does.
std::unique_ptr<HapticDevice> open_entact(const std::string& address, Clock& clock);
// Checks the library only: the library searches for devices when one is opened.
Availability entact_availability();

// A 3Dconnexion SpaceMouse, through the daemon spacenavd: input only, six axes, no motors. Needs no library.
//
// The address is the path of the daemon's socket, and settings. The default path is that of the environment
// variable SPNAV_SOCKET, or else /var/run/spnav.sock. Settings:
//   speed=M_PER_S      speed for each count of deflection, by default 0.0005; a mouse sends up to about 350
//   turning=RAD_PER_S  angular speed for each count of deflection, by default 0.003
//   box=M              half the width of the workspace, by default 0.15; the position is kept within
//
// The deflection is used as a velocity and integrated to a pose, which starts in the middle of the box. A
// deflection is used for at most 0.5 s unless it is reported again, so that an unplugged mouse comes to rest;
// if the daemon does not repeat a constant deflection, set repeat-interval = 250 in its settings. Rotations
// are about the axes of the device's frame, not those of the handle.
//
// Axes of the daemon, as its own library uses them: x to the right, y up, z away from the user, and rotations
// about x, y and -z. The settings of the daemon (spacenavd's configuration file) can change them.
//
// read() processes the messages that have arrived and does not wait. It returns a fault after the daemon has
// closed the connection; the device must then be opened again. write() exerts no force and returns the fault
// of read(), if any. release() does nothing.
std::unique_ptr<HapticDevice> open_spacenav(const std::string& address, Clock& clock);
// Reports whether the daemon accepts a connection. The daemon does not report which mouse it has, if any.
Availability spacenav_availability(const std::string& address, const Clock& clock);

// Parts that the adapters of vendors' libraries share.

// The availability of devices whose library does not report them before one is opened.
template <class Functions>
Availability availability_of_library() {
  return availability_of([] {
    return Availability{
        .detail = Functions().library.file() + ": a device is detected only when one is opened",
        .was_searched = false};
  });
}

// Converts from the axes of Force Dimension and Entact, x towards the user, y to the right, z up, to ours: x
// right, y up, z towards the user. The second function converts back.
inline Vec3 from_user_right_up(const Vec3& v) {
  return {v.y(), v.z(), v.x()};
}
inline Vec3 to_user_right_up(const Vec3& v) {
  return {v.z(), v.x(), v.y()};
}

// The handle's axes are renamed like the device's, so that the vendor's identity is the identity here too.
inline Eigen::Matrix3d rotation_from_user_right_up(const Eigen::Matrix3d& rotation) {
  Eigen::Matrix3d rotated;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) rotated(i, j) = rotation((i + 1) % 3, (j + 1) % 3);
  return rotated;
}

// True if m is a rotation within the errors of encoders and single precision; false if a value is not finite.
inline bool is_rotation(const Eigen::Matrix3d& m) {
  constexpr double kSlack = 1e-3;
  return ((m * m.transpose() - Eigen::Matrix3d::Identity()).array().abs() < kSlack).all() &&
         m.determinant() > 0;
}

// Texts for vendors' error codes. They are valid for the whole run of the program; the vendors' own texts may
// not be.
struct KnownFault {
  int code;
  const char* what;
};

// Returns the fault of this code with its known text. what: the text for an unknown code.
inline DeviceFault fault_of(std::span<const KnownFault> known, int code, const char* what) {
  for (const KnownFault& fault : known)
    if (fault.code == code) what = fault.what;
  return {what, code};
}

inline constexpr DeviceFault kNoRotation{"the device reports an orientation that is not a rotation", 0};

// The table of the devices: one line each.

// The objects that a device may need. All but poses must outlive it.
struct DeviceContext {
  const Experiment& experiment;
  const Kernels& kernels;
  Clock& clock;
  std::shared_ptr<HandPoses> poses = nullptr;  // poses from a page of the viewer, for browser:
};

struct DeviceEntry {
  const char* scheme;
  const char* example;
  const char* summary;
  std::unique_ptr<HapticDevice> (*open)(const std::string& address, const DeviceContext& context);
  Availability (*availability)();
};

std::span<const DeviceEntry> devices();

// Throws InputError when the device cannot be opened.
std::unique_ptr<HapticDevice> open_device(const std::string& uri, const DeviceContext& context);

}  // namespace remote_touch
