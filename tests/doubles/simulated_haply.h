// A simulated Inverse service of Haply: the devices behind it, the messages that describe them, and the
// service on a simulated clock, whose link answers each command after a time, or not at all.
#pragma once

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/points/vector.h"
#include "runners/live/devices/haply.h"
#include "tests/doubles/simulated_clock.h"

namespace remote_touch {

struct HaplyCommand {
  std::string device_id, key;
  Vec3 force_N = Vec3::Zero();
};

inline std::vector<HaplyCommand> haply_commands(const std::string& message) {
  std::vector<HaplyCommand> commands;
  const nlohmann::json parsed = nlohmann::json::parse(message);
  for (const nlohmann::json& device : parsed.at("inverse3"))
    for (const auto& [key, force] : device.at("commands").at("set_cursor_force").items())
      commands.push_back({device.at("device_id"), key, Vec3(force.at("x"), force.at("y"), force.at("z"))});
  return commands;
}

// All vectors are in the service's axes: x to the right, y away from the user, z up.
struct HaplyWorld {
  Vec3 position_m = Vec3(0.01, -0.12, 0.15), velocity_m_per_s = Vec3::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  bool a = false, b = false, c = false;

  std::vector<std::string> devices = {"049D"};
  bool has_handle = true;
  bool is_handle_wired = false;
  std::string basis = "XYZ";
  std::string force_key = "vector";  // the key that it knows; it ignores other keys
  bool reports_force = true;
  double force_factor = 1;      // the force that it gives, per commanded force
  Vec3 other_N = Vec3::Zero();  // force that other programs command
  std::string answer;           // sent instead of a state
  std::string inventory;        // sent instead of the inventory

  // Returns the force that the first device gives after such a command.
  Vec3 given_N(const HaplyCommand& command) const {
    return (command.key == force_key ? force_factor : 0) * command.force_N + other_N;
  }
  // now_N: the force that the device gives now.
  std::string inventory_message(const Vec3& now_N) const {
    return inventory.empty() ? message(now_N, true) : inventory;
  }
  std::string state_message(const Vec3& now_N) const {
    return answer.empty() ? message(now_N, false) : answer;
  }

 private:
  using Json = nlohmann::json;

  static Json of(const Vec3& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }
  // The cursor belongs to the first device. Another device is at another position.
  Json device(const std::string& id, const Vec3& now_N, bool is_inventory) const {
    Json state = {{"control_mode", "force"},
                  {"current_cursor_position", of(Vec3(7, 7, 7))},
                  {"cursor_position", of(id == devices.front() ? position_m : Vec3(9, 9, 9))},
                  {"cursor_velocity", of(velocity_m_per_s)}};
    if (reports_force) state["current_cursor_force"] = of(now_N);
    Json all = {{"device_id", id}, {"state", state}, {"status", {{"calibrated", true}}}};
    if (is_inventory) all["config"] = {{"type", "inverse3"}, {"basis", {{"permutation", basis}}}};
    return all;
  }
  std::string message(const Vec3& now_N, bool is_inventory) const {
    Json all = {{"inverse3", Json::array()}};
    if (is_inventory) all["session_id"] = 7;
    for (const std::string& id : devices) all["inverse3"].push_back(device(id, now_N, is_inventory));
    if (!has_handle) return all.dump();
    const Eigen::Quaterniond& q = orientation;
    Json state = {{"orientation", {{"w", q.w()}, {"x", q.x()}, {"y", q.y()}, {"z", q.z()}}}, {"hall", 0}};
    if (is_handle_wired)
      state["button"] = a;
    else
      state["buttons"] = {{"a", a}, {"b", b}, {"c", c}};
    all[is_handle_wired ? "verse_grip" : "wireless_verse_grip"] = {
        {{"device_id", "61548"}, {"state", state}, {"status", {{"error", 0}}}}};
    return all.dump();
  }
};

class SimulatedHaply {
 public:
  struct Sent {
    std::int64_t at_ns;
    HaplyCommand command;
  };

  explicit SimulatedHaply(SimulatedClock& clock) : clock_(clock) {}
  // Opens the adapter at this service. settings is appended to its address.
  std::unique_ptr<HapticDevice> open(const std::string& settings = "") {
    is_cut_ = false;
    answers_.assign(1, {clock_.now_ns(), world.inventory_message(given_N_)});
    return open_haply(settings, clock_, [this](const DeviceAddress&, const Clock&, double) {
      return std::make_unique<Link>(*this);
    });
  }

  HaplyWorld world;
  std::int64_t answers_after_ns = 200'000;
  // The service does not answer from now on. Answers that were due come with resume().
  void hang() { hangs_ = true; }
  void resume() {
    hangs_ = false;
    for (Answer& answer : answers_) answer.due_ns = std::max(answer.due_ns, clock_.now_ns());
  }
  // Ends the connection.
  void die() { is_dead_ = true; }

  const std::vector<Sent>& sent() const { return sent_; }
  bool is_cut() const { return is_cut_; }

 private:
  struct Answer {
    std::int64_t due_ns;
    std::string text;
  };
  class Link final : public HaplyLink {
   public:
    explicit Link(SimulatedHaply& service) : service_(service) {}

    DeviceFault send(std::string_view text, double) noexcept override {
      if (service_.is_dead_ || service_.is_cut_) return kClosed;
      const std::int64_t now_ns = service_.clock_.now_ns();
      for (const HaplyCommand& command : haply_commands(std::string(text))) {
        service_.sent_.push_back({now_ns, command});
        service_.given_N_ = service_.world.given_N(command);
      }
      service_.answers_.push_back(
          {now_ns + service_.answers_after_ns, service_.world.state_message(service_.given_N_)});
      return {};
    }
    DeviceFault receive(std::string_view& text, double deadline_s) noexcept override {
      SimulatedClock& clock = service_.clock_;
      const std::int64_t deadline_ns = std::llround(1e9 * deadline_s);
      for (;;) {
        if (service_.is_dead_ || service_.is_cut_) return kClosed;
        const bool is_owed = !service_.hangs_ && !service_.answers_.empty();
        if (is_owed && service_.answers_.front().due_ns <= clock.now_ns()) break;
        if (clock.now_ns() >= deadline_ns) return {"the Haply service does not answer", ETIMEDOUT};
        // The wait is split into steps, because an event during it may end it.
        clock.sleep_until_ns(std::min(deadline_ns, clock.now_ns() + 10'000));
      }
      last_ = std::move(service_.answers_.front().text);
      service_.answers_.pop_front();
      text = last_;
      return {};
    }
    void cut() noexcept override { service_.is_cut_ = true; }

   private:
    static constexpr DeviceFault kClosed{"the Haply service closed the connection"};

    SimulatedHaply& service_;
    std::string last_;
  };

  SimulatedClock& clock_;
  std::vector<Sent> sent_;
  std::deque<Answer> answers_;
  Vec3 given_N_ = Vec3::Zero();
  bool hangs_ = false, is_dead_ = false, is_cut_ = false;
};

}  // namespace remote_touch
