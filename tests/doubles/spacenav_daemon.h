// The stock daemon spacenavd with a mouse: a pseudo-terminal that answers like a serial Magellan SpaceMouse.
#pragma once

#include <sys/types.h>

#include <array>
#include <atomic>
#include <filesystem>
#include <string>
#include <thread>

namespace remote_touch {

// The mouse's frame is x to the right, y up, z towards the user, which are the axes of its packets.
class SerialMouse {
 public:
  SerialMouse();
  ~SerialMouse();

  const std::string& terminal() const { return terminal_; }  // terminal that the daemon opens
  bool is_detected() const { return is_detected_; }          // the daemon has switched its reports on
  // Deflects the mouse along and about x, y and z, in counts.
  void deflect(const std::array<int, 6>& counts);
  void press(unsigned buttons);  // buttons: one bit for each that is down

 private:
  void answer();
  void send(const std::string& packet);

  int handle_ = -1;
  std::string terminal_;
  std::atomic<bool> is_detected_{false}, is_over_{false};
  std::thread thread_;
};

// Path of the installed daemon; empty if it is not installed.
std::string spacenav_daemon_program();

// The daemon runs in a folder of its own, where it makes its socket.
class SpacenavDaemon {
 public:
  SpacenavDaemon(const std::filesystem::path& folder, const std::string& terminal);
  ~SpacenavDaemon() { kill(); }

  std::string socket() const { return (folder_ / "run/spnav.sock").string(); }
  void kill();

 private:
  std::filesystem::path folder_;
  pid_t child_ = -1;
};

}  // namespace remote_touch
