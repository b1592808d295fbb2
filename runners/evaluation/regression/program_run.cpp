#include "runners/evaluation/regression/program_run.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <new>
#include <string_view>
#include <thread>

#include "core/parameters/input_error.h"
#include "runners/experiment/simulation/simulation.h"

namespace remote_touch {

namespace {

// File actions of a spawned program: its output is discarded, and its errors are written to a file.
class OutputTo {
 public:
  explicit OutputTo(const std::filesystem::path& errors) : errors_(errors) {
    const int error =
        ::posix_spawn_file_actions_init(&actions_) != 0
            ? ENOMEM
            : first_of(::posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0),
                       ::posix_spawn_file_actions_addopen(&actions_, STDERR_FILENO, errors_.c_str(),
                                                          O_WRONLY | O_CREAT | O_TRUNC, 0666));
    if (error != 0) throw std::bad_alloc();
  }
  ~OutputTo() { ::posix_spawn_file_actions_destroy(&actions_); }
  OutputTo(const OutputTo&) = delete;
  OutputTo& operator=(const OutputTo&) = delete;
  const posix_spawn_file_actions_t* actions() const { return &actions_; }

 private:
  static int first_of(int a, int b) { return a != 0 ? a : b; }
  const std::string errors_;
  posix_spawn_file_actions_t actions_{};
};

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> all;
  for (std::string& text : texts) all.push_back(text.data());
  all.push_back(nullptr);
  return all;
}

// This process's environment, which its programs inherit, with some variables set in addition: "NAME=value".
std::vector<std::string> environment_with(const std::map<std::string, std::string>& more) {
  std::vector<std::string> all;
  for (char** one = environ; *one; ++one) {
    const std::string_view text = *one;
    if (!more.contains(std::string(text.substr(0, text.find('='))))) all.emplace_back(text);
  }
  for (const auto& [name, value] : more) all.push_back(name + "=" + value);
  return all;
}

// Spawns the program and does not fork: a child that runs out of memory between fork and exec would continue
// as a second copy of this program.
pid_t start(const std::string& program, std::vector<std::string> arguments,
            const std::map<std::string, std::string>& environment, const std::filesystem::path& errors) {
  arguments.insert(arguments.begin(), program);
  std::vector<std::string> variables = environment_with(environment);
  const OutputTo output(errors);
  pid_t child = 0;
  const int error = ::posix_spawn(&child, program.c_str(), output.actions(), nullptr,
                                  pointers(arguments).data(), pointers(variables).data());
  if (error != 0)
    throw InputError(program, std::string("cannot be started (") + std::strerror(error) +
                                  "): expected a build of remote-touch");
  return child;
}

// Waits for the child and returns its status. When stop is set, sends SIGTERM to the child, waits for its end
// and throws Interrupted. Throws InputError if the status is not known, as when this process ignores SIGCHLD.
int end_of(pid_t child, const std::string& program, const std::atomic<bool>* stop) {
  int status = 0;
  bool signalled = false;
  pid_t ended = 0;
  while ((ended = ::waitpid(child, &status, WNOHANG)) == 0) {
    if (stop && *stop && !signalled) ::kill(child, SIGTERM), signalled = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  const int error = errno;
  if (stop && *stop) throw Interrupted{};
  if (ended < 0)
    throw InputError(program, std::string("has an unknown end (") + std::strerror(error) +
                                  "): expected a caller that does not ignore SIGCHLD");
  return status;
}

// Returns the last line that the program wrote to standard error, in parentheses; empty if it wrote none.
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
  const pid_t child = start(program, arguments, environment, errors);
  const int status = end_of(child, program, stop);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  throw InputError(program, "failed with " +
                                (WIFEXITED(status) ? "exit code " + std::to_string(WEXITSTATUS(status))
                                                   : "signal " + std::to_string(WTERMSIG(status))) +
                                last_line(errors) + ": expected a build that runs what is to be stored");
}

}  // namespace remote_touch
