// A stand-in for Haply's Inverse service: the protocol of its documentation over a real WebSocket on a free
// port of this machine, with a cursor and a handle that a test sets, and with faults.
#pragma once

#include <sys/types.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/doubles/haply_world.h"

namespace remote_touch {

class HaplyService {
 public:
  explicit HaplyService(const HaplyWorld& world = {});
  ~HaplyService();

  int port() const;
  std::string address() const { return "ws://127.0.0.1:" + std::to_string(port()); }

  // How it answers a command from now on: with no answer, or half of one, or control frames instead; the
  // connection stays. is_dead: it ends the connection and accepts no other.
  enum class Mood { answers, hangs, hangs_in_the_middle, pings, is_dead };
  void set(Mood mood);
  bool misbehaves() const;  // half an answer or a control frame has been sent

  std::vector<HaplyCommand> commands() const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

// The same service in a process of its own, which can be killed, and whose allocations are not counted.
class HaplyServiceProcess {
 public:
  HaplyServiceProcess();
  ~HaplyServiceProcess() { kill(); }
  std::string address(const std::string& settings = "") const {
    return "ws://127.0.0.1:" + std::to_string(port_) + settings;
  }
  void kill();

 private:
  pid_t child_ = -1;
  int port_ = 0;
};

}  // namespace remote_touch
