// A stand-in for Haply's Inverse service: the protocol of its documentation over a real WebSocket on a free
// port of this machine, with a cursor and a handle that a test sets, and with what goes wrong.
#pragma once

#include <sys/types.h>

#include <memory>
#include <string>
#include <vector>

#include "core/geometry/vector.h"

namespace remote_touch {

// All in the service's axes: x to the right, y away from the user, z up.
struct HaplyWorld {
  Vec3 position_m = Vec3(0.01, -0.12, 0.15), velocity_m_per_s = Vec3::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  bool a = false, b = false, c = false;

  std::vector<std::string> devices = {"049D"};
  bool has_handle = true;
  bool is_handle_wired = false;
  std::string basis = "XYZ";
  std::string force_key = "vector";  // the one it knows; another is passed over, as unknown keys are
  bool reports_force = true;
  double gate = 1;              // what it gives of the force that it is sent
  Vec3 other_N = Vec3::Zero();  // what others at the service command
  std::string answer;           // instead of a state
  std::string inventory;        // instead of the inventory
};

class HaplyService {
 public:
  struct Command {
    double time_s = 0;
    std::string device_id, key;
    Vec3 force_N = Vec3::Zero();
  };

  explicit HaplyService(const HaplyWorld& world = {});
  ~HaplyService();

  int port() const;
  std::string address(const std::string& settings = "") const;

  void set(const HaplyWorld& world);
  // No answer from now on, or half of one, or control frames instead; the connection stays.
  void hang();
  void hang_in_the_middle();
  void ping_without_end();
  void resume();
  // Ends the connection and takes no other.
  void die();

  std::vector<Command> commands() const;
  int connections() const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

// The same in a process of its own, to be killed, and to allocate where it is not counted.
class HaplyServiceProcess {
 public:
  HaplyServiceProcess();
  ~HaplyServiceProcess() { kill(); }
  std::string address(const std::string& settings = "") const;
  void kill();

 private:
  pid_t child_ = -1;
  int port_ = 0;
};

}  // namespace remote_touch
