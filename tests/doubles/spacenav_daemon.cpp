#include "tests/doubles/spacenav_daemon.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace remote_touch {

namespace {

// A packet holds four bits per character. The manufacturer's letters have the values as their lower halves.
constexpr char kNibbles[] = "0AB3D56GH9:K<MN?";

}  // namespace

SerialMouse::SerialMouse() : handle_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
  if (handle_ < 0 || ::grantpt(handle_) != 0 || ::unlockpt(handle_) != 0)
    throw std::runtime_error("no pseudo-terminal");
  terminal_ = ::ptsname(handle_);
  thread_ = std::thread([this] { answer(); });
}

SerialMouse::~SerialMouse() {
  is_over_ = true;
  thread_.join();
  ::close(handle_);
}

// The daemon first sends the commands of a Spaceball, which this mouse is not, and then requests the version
// (vQ). It switches the reports on with m3, which the mouse repeats.
void SerialMouse::answer() {
  std::string command;
  while (!is_over_) {
    pollfd one{handle_, POLLIN, 0};
    char c = 0;
    if (::poll(&one, 1, 20) <= 0 || (one.revents & POLLIN) == 0 || ::read(handle_, &c, 1) != 1) {
      if ((one.revents & POLLHUP) != 0) ::usleep(1000);  // no program has it open
      continue;
    }
    if (c != '\r') {
      command += c;
      continue;
    }
    if (command == "vQ") send("vMAGELLAN  Version 6.60  3Dconnexion GmbH 05/11/01");
    if (command == "m3") {
      send("m3");
      is_detected_ = true;
    }
    command.clear();
  }
}

void SerialMouse::send(const std::string& packet) {
  const std::string line = packet + '\r';
  if (::write(handle_, line.data(), line.size()) != static_cast<ssize_t>(line.size()))
    throw std::runtime_error("the pseudo-terminal is full");
}

void SerialMouse::deflect(const std::array<int, 6>& counts) {
  std::string packet = "d";
  for (const int count : counts)
    for (int shift = 12; shift >= 0; shift -= 4) packet += kNibbles[((count + 0x8000) >> shift) & 15];
  send(packet);
}

void SerialMouse::press(unsigned buttons) {
  std::string packet = "k";
  for (int shift = 0; shift < 12; shift += 4) packet += kNibbles[(buttons >> shift) & 15];
  send(packet);
}

std::string spacenav_daemon_program() {
  for (const char* program : {"/usr/bin/spacenavd", "/usr/sbin/spacenavd", "/usr/local/bin/spacenavd"})
    if (::access(program, X_OK) == 0) return program;
  return "";
}

SpacenavDaemon::SpacenavDaemon(const std::filesystem::path& folder, const std::string& terminal)
    : folder_(folder) {
  std::filesystem::create_directories(folder / "run");
  std::ofstream(folder / "spnavrc") << "serial = " << terminal << "\n";
  const std::string program = spacenav_daemon_program(), settings = (folder / "spnavrc").string();
  const std::string log = (folder / "log").string();
  child_ = ::fork();
  if (child_ != 0) return;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::unsetenv("DISPLAY");
  const int out = ::open(log.c_str(), O_WRONLY | O_CREAT, 0600);
  ::dup2(out, 1);
  ::dup2(out, 2);
  if (::chdir(folder.c_str()) == 0)
    ::execl(program.c_str(), program.c_str(), "-d", "-v", "-c", settings.c_str(),
            static_cast<char*>(nullptr));
  ::_exit(127);
}

void SpacenavDaemon::kill() {
  if (child_ <= 0) return;
  ::kill(child_, SIGKILL);
  ::waitpid(child_, nullptr, 0);
  child_ = -1;
}

}  // namespace remote_touch
