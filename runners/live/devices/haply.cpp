#include "runners/live/devices/haply.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "runners/live/devices/device_table.h"

namespace remote_touch {

namespace {

constexpr double kOpenWithin_s = 1;
// A tick must report a fault within 10 ms. The sum of these times is below that, with 1 ms added to each for
// the rest of a message that has begun.
constexpr double kReadWithin_s = 6e-3, kWriteWithin_s = 1.5e-3;
constexpr double kLastAnswerWithin_s = 20e-3;
constexpr std::int64_t kTickEndsWithin_ns = 5'000'000, kLinkPollPeriod_ns = 100'000;
constexpr double kStateLasts_s = 20e-3;  // if the last command is older, the state is requested again
constexpr double kUnfollowed_s = 50e-3;
constexpr double kMinCheckedForce_N = 0.3, kMinFraction = 0.1, kMaxSurplus_N = 1;

constexpr DeviceFault kLate{"the Haply service answers too late"};
constexpr DeviceFault kNoState{"the Haply service sent a message that is not a state"};
constexpr DeviceFault kDeviceGone{"the Inverse3 is no longer in the states of the service"};
constexpr DeviceFault kNoVelocity{"the Inverse3 sent no cursor_velocity: expected x, y and z in every state"};
constexpr DeviceFault kHandleGone{"the handle is no longer in the states of the service"};
constexpr DeviceFault kNoOrientation{"the handle sent an orientation that is not a unit quaternion"};
constexpr DeviceFault kNoForce{"the commanded force is not finite"};
constexpr DeviceFault kTryValues{"the service does not apply the force that it is sent; try force=values"};
constexpr DeviceFault kTryVector{"the service does not apply the force that it is sent; try force=vector"};
constexpr DeviceFault kOtherForce{"the service applies a force that it was not sent"};

// The service has y away from the user and z up.
Vec3 from_service(const Vec3& v) {
  return {v.x(), v.z(), -v.y()};
}
Vec3 to_service(const Vec3& v) {
  return {v.x(), -v.z(), v.y()};
}

// Checks whether the force that the service reports follows the commands. A gate, damping and other programs
// at the same service may change it much, so only two faults are reported: a commanded force is missing, or a
// force was not commanded.
class ForceCheck {
 public:
  explicit ForceCheck(double now_s) : followed_s_(now_s) {}
  DeviceFault operator()(const Vec3& sent, const Vec3& given, HaplyForceKey key, double now_s) {
    const bool is_missing =
        sent.norm() > kMinCheckedForce_N && given.dot(sent) < kMinFraction * sent.dot(sent);
    const bool is_other = given.norm() > sent.norm() + kMaxSurplus_N;
    if (!is_missing && !is_other) followed_s_ = now_s;
    if (now_s - followed_s_ < kUnfollowed_s) return {};
    if (is_other) return kOtherForce;
    return key == HaplyForceKey::vector ? kTryValues : kTryVector;
  }

 private:
  double followed_s_;
};

DeviceFault convert(const HaplyMessage& message, bool has_handle, DeviceReading& reading) {
  if (!message.device || !message.device->position_m) return kDeviceGone;
  // The limit of the speed needs it: a velocity of zero would always pass.
  if (!message.device->velocity_m_per_s) return kNoVelocity;
  reading = {};
  reading.position_m = from_service(*message.device->position_m);
  reading.velocity_m_per_s = from_service(*message.device->velocity_m_per_s);
  if (!has_handle) return {};
  if (!message.handle || !message.handle->orientation) return kHandleGone;
  const Eigen::Vector4d& q = *message.handle->orientation;
  // The service rounds, so the norm may differ a little from 1. A handle that sleeps sends zeros: a fault.
  if (std::abs(q.norm() - 1) > 0.1) return kNoOrientation;
  const Vec3 axis = from_service(q.head<3>());
  reading.orientation = Eigen::Quaterniond(q.w(), axis.x(), axis.y(), axis.z()).normalized();
  reading.buttons = message.handle->buttons;
  return {};
}

struct Opened {
  std::unique_ptr<HaplyLink> link;
  std::string device_id, handle_id;  // empty: no handle
};

// Connects and reads the inventory. Sends no command.
Opened open_service(const DeviceAddress& address, const Clock& clock, double time_s,
                    const HaplyLinkOpener& open_link) {
  const double deadline_s = clock.now_s() + time_s;
  Opened opened{open_link(address, clock, deadline_s), "", ""};
  std::string_view text;
  const DeviceFault fault = opened.link->receive(text, deadline_s);
  if (fault)
    throw address.refusal(std::string(fault.what) +
                          ", but an inventory was expected; is this the Inverse service?");
  HaplyMessage inventory;
  const std::string device = address.word("device", ""), handle = address.word("handle", "");
  if (!read_haply_message(text, device, handle, inventory))
    throw address.refusal(
        "the first message of the service is not an inventory; is this the Inverse service?");
  if (!inventory.device)
    throw address.refusal("the service lists no Inverse3" + (device.empty() ? "" : " \"" + device + "\"") +
                          "; plug it in and wait until the service lists it");
  if (!handle.empty() && !inventory.handle)
    throw address.refusal("the service lists no handle \"" + handle + "\"; pair it or omit the setting");
  const std::string_view basis = inventory.device->basis;
  if (!basis.empty() && basis != "XYZ")
    throw address.refusal("the service is set to the basis " + std::string(basis) +
                          "; set the basis of this program back to XYZ");
  opened.device_id = inventory.device->id;
  if (inventory.handle) opened.handle_id = inventory.handle->id;
  return opened;
}

DeviceAddress haply_address(const std::string& address) {
  return {"haply", address, {"force", "rate", "device", "handle", "check"}};
}

class Haply final : public HapticDevice {
 public:
  Haply(const DeviceAddress& address, Clock& clock, const HaplyLinkOpener& open_link)
      : HapticDevice(clock), check_(clock.now_s()) {
    key_ = address.choice("force", {"vector", "values"}) == "vector" ? HaplyForceKey::vector
                                                                     : HaplyForceKey::values;
    is_checked_ = address.choice("check", {"on", "off"}) == "on";
    traits_.tick_rate_hz = address.number("rate", 1000, 100, 8000);
    opened_ = open_service(address, clock, kOpenWithin_s, open_link);
    if (!command_.set_device(opened_.device_id, key_))
      throw address.refusal(
          "the ID of the device cannot be part of a command; choose another device with device=ID");
    traits_.name = "Haply Inverse3 " + opened_.device_id;
    traits_.sensed_axes = opened_.handle_id.empty() ? 3 : 6;
    // A service that does not follow the protocol is reported here and not in the first tick. After this read
    // the first tick has nothing to allocate.
    DeviceReading first;
    if (const DeviceFault fault = read_within(first, kOpenWithin_s))
      throw address.refusal(std::string("no first state (") + fault.what +
                            "); is the device calibrated and on?");
  }
  ~Haply() override { release(); }

  DeviceFault read(DeviceReading& reading) noexcept override {
    const LinkLock lock(taken_);
    return lock ? read_within(reading, kReadWithin_s) : kReleased;
  }

  // The motors of an Inverse3 give no torque.
  DeviceFault write(const Wrench& wrench) noexcept override {
    const LinkLock lock(taken_);
    if (!lock) return kReleased;
    const bool is_force = wrench.force_N.allFinite();
    const double deadline_s = clock().now_s() + kWriteWithin_s;
    // The answer that is due is read first: with two commands in progress the answers would stay one behind.
    // If it is missing, no command is sent, and the device idles.
    std::string_view late;
    if (const DeviceFault fault = receive_due_answer(late, deadline_s)) return fault;
    const DeviceFault fault = send(is_force ? to_service(wrench.force_N) : Vec3::Zero(), deadline_s);
    return is_force ? fault : kNoForce;
  }

  void release() noexcept override {
    if (is_released_.exchange(true)) return;
    const std::int64_t until_ns = clock().now_ns() + kTickEndsWithin_ns;
    bool is_mine = false;
    while (!(is_mine = !taken_.exchange(true)) && clock().now_ns() < until_ns)
      clock().sleep_until_ns(clock().now_ns() + kLinkPollPeriod_ns);
    if (is_mine) {
      const bool is_older_due = is_answer_due_;
      const double deadline_s = clock().now_s() + kLastAnswerWithin_s;
      // Waits for the answers: a connection that is closed with unread bytes can lose the command.
      std::string_view text;
      if (!send(Vec3::Zero(), deadline_s) && !receive_due_answer(text, deadline_s) && is_older_due)
        opened_.link->receive(text, deadline_s);
    }
    opened_.link->cut();
  }

 private:
  // Exclusive use of the link during one call. Only release() competes for the link, and keeps it when it has
  // got it, so no tick waits.
  class LinkLock {
   public:
    explicit LinkLock(std::atomic<bool>& taken) : taken_(taken), is_mine_(!taken.exchange(true)) {}
    ~LinkLock() {
      if (is_mine_) taken_ = false;
    }
    explicit operator bool() const { return is_mine_; }

   private:
    std::atomic<bool>& taken_;
    const bool is_mine_;
  };

  DeviceFault send(const Vec3& force_N, double deadline_s) noexcept {
    const DeviceFault fault = opened_.link->send(command_.text(force_N), deadline_s);
    if (fault) return fault;
    sent_N_ = force_N;
    sent_s_ = clock().now_s();
    is_answer_due_ = true;
    return {};
  }

  // Receives the answer to the last command, if it has not been received yet.
  DeviceFault receive_due_answer(std::string_view& text, double deadline_s) noexcept {
    if (!is_answer_due_) return {};
    const DeviceFault fault = opened_.link->receive(text, deadline_s);
    if (!fault) is_answer_due_ = false;
    return fault;
  }

  // Stores the answer to the last command in `text`. If that command is older than kStateLasts_s, or no
  // answer is due, it sends a command with zero force and stores the answer to that one.
  DeviceFault newest(std::string_view& text, double deadline_s) noexcept {
    const bool is_old = !is_answer_due_ || clock().now_s() - sent_s_ > kStateLasts_s;
    if (const DeviceFault fault = receive_due_answer(text, deadline_s)) return fault;
    if (!is_old) return {};
    if (clock().now_s() > deadline_s)
      return kLate;  // the rest of a message may take 1 ms more, but only once
    if (const DeviceFault fault = send(Vec3::Zero(), deadline_s)) return fault;
    return receive_due_answer(text, deadline_s);
  }

  DeviceFault read_within(DeviceReading& reading, double time_s) noexcept {
    std::string_view text;
    if (const DeviceFault fault = newest(text, clock().now_s() + time_s)) return fault;
    HaplyMessage message;
    if (!read_haply_message(text, opened_.device_id, opened_.handle_id, message)) return kNoState;
    DeviceReading found;
    if (const DeviceFault fault = convert(message, !opened_.handle_id.empty(), found)) return fault;
    if (is_checked_ && message.device->force_N)
      if (const DeviceFault fault = check_(sent_N_, *message.device->force_N, key_, clock().now_s()))
        return fault;
    reading = found;
    return {};
  }

  Opened opened_;
  HaplyForceCommand command_;
  HaplyForceKey key_ = HaplyForceKey::vector;
  bool is_checked_ = true;
  ForceCheck check_;

  std::atomic<bool> taken_{false}, is_released_{false};
  Vec3 sent_N_ = Vec3::Zero();  // last command, in the service's axes
  double sent_s_ = 0;
  bool is_answer_due_ = false;
};

}  // namespace

std::unique_ptr<HapticDevice> open_haply(const std::string& address, Clock& clock,
                                         const HaplyLinkOpener& open_link) {
  return std::make_unique<Haply>(haply_address(address), clock, open_link);
}

Availability haply_availability(const Clock& clock) {
  Availability availability = availability_of([&] {
    const Opened opened = open_service(haply_address(""), clock, 0.3, open_haply_link);
    return Availability{
        .found = true,
        .detail = "Inverse3 " + opened.device_id +
                  (opened.handle_id.empty() ? " without a handle" : " with the handle " + opened.handle_id)};
  });
  availability.compiled_in = haply_link_is_compiled_in();
  return availability;
}

}  // namespace remote_touch
