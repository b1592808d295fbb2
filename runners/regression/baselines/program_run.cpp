#include "runners/regression/baselines/program_run.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <thread>

#include "core/parameters/input_error.h"
#include "runners/simulation/simulation.h"

namespace remote_touch {

namespace {

constexpr int kCannotStart = 127;

void redirect(int stream, const char* file) {
  const int to = ::open(file, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (to >= 0) ::dup2(to, stream);
}

// In the child.
[[noreturn]] void become(const std::string& program, const std::vector<std::string>& arguments,
                         const std::map<std::string, std::string>& environment,
                         const std::filesystem::path& errors) {
  for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
  redirect(STDOUT_FILENO, "/dev/null");
  redirect(STDERR_FILENO, errors.c_str());
  std::vector<char*> words = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  ::execv(program.c_str(), words.data());
  ::_exit(kCannotStart);
}

// Its status. Signals that this program gets are handed on.
int end_of(pid_t child, const std::atomic<bool>* stop) {
  int status = 0;
  bool signalled = false;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    if (stop && *stop && !signalled) ::kill(child, SIGTERM), signalled = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  if (stop && *stop) throw Interrupted{};
  return status;
}

// In parentheses; empty where it said nothing.
std::string last_line(const std::filesystem::path& errors) {
  std::ifstream in(errors);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) last = " (" + line + ")";
  return last;
}

}  // namespace

std::string this_program() {
  return std::filesystem::read_symlink("/proc/self/exe").string();
}

void run_program(const std::string& program, const std::vector<std::string>& arguments,
                 const std::map<std::string, std::string>& environment, const std::filesystem::path& errors,
                 const std::atomic<bool>* stop) {
  const pid_t child = ::fork();
  if (child < 0) throw InputError(program, std::string("cannot be started (") + std::strerror(errno) + ")");
  if (child == 0) become(program, arguments, environment, errors);
  const int status = end_of(child, stop);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  if (WIFEXITED(status) && WEXITSTATUS(status) == kCannotStart)
    throw InputError(program, "cannot be started: expected a build of remote-touch");
  throw InputError(program, "failed with " +
                                (WIFEXITED(status) ? "exit code " + std::to_string(WEXITSTATUS(status))
                                                   : "signal " + std::to_string(WTERMSIG(status))) +
                                last_line(errors) + ": expected a build that runs what is to be stored");
}

}  // namespace remote_touch
