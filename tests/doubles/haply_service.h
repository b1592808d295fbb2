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
  std::string address(const std::string& settings = "") const;

  void set(const HaplyWorld& world);
  // The service sends no answer to a command from now on, or half of one, or control frames instead. The
  // connection stays.
  void hang();
  void hang_in_the_middle();
  void ping_without_end();
  void resume();
  bool misbehaves() const;  // half an answer or a control frame has been sent
  // Ends the connection and accepts no other.
  void die();

  std::vector<HaplyCommand> commands() const;
  int connections() const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

// The same service in a process of its own, which can be killed, and whose allocations are not counted.
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
