// Answers requests with copies of the program, see fail_once.cpp.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "fail_once.h"

namespace {

bool read_line(char* line, std::size_t capacity) {
  std::size_t size = 0;
  while (size + 1 < capacity && ::read(STDIN_FILENO, line + size, 1) == 1 && line[size] != '\n') ++size;
  const bool whole = line[size] == '\n';
  line[size] = '\0';
  return whole;
}

void redirect(int stream, const char* place, const char* name, int flags) {
  char path[4096];
  std::snprintf(path, sizeof path, "%s%s", place, name);
  const int file = next<int(const char*, int, ...)>("open")(path, flags | O_CLOEXEC, 0666);
  ::dup2(file, stream);
}

void set_below(const char* name, const char* place, const char* below) {
  char path[4096];
  std::snprintf(path, sizeof path, "%s%s", place, below);
  ::setenv(name, path, 1);
}

// Runs in the copy of the program.
void take_request(const char* failing_call, const char* process, const char* place) {
  redirect(STDIN_FILENO, "/dev/null", "", O_RDONLY);
  redirect(STDOUT_FILENO, place, "/out", O_WRONLY | O_CREAT | O_TRUNC);
  redirect(STDERR_FILENO, place, "/err", O_WRONLY | O_CREAT | O_TRUNC);
  set_below("FAIL_ONCE_BELOW", place, "/made");
  set_below("TMPDIR", place, "/made/tmp");
  set_below("REMOTE_TOUCH_CACHE", place, "/made/cache");
  ::unsetenv("FAIL_ONCE_SERVER");
  ::setenv("FAIL_ONCE", failing_call, 1);
  if (std::strcmp(process, "0") != 0) ::setenv("FAIL_ONCE_PROCESS", process, 1);
  count_below(place, "/made");
  if (::chdir(std::getenv("FAIL_ONCE_BELOW")) != 0) ::_exit(125);
  this_process.is_chosen = std::strcmp(process, "0") == 0 || std::strcmp(process, "1") == 0;
  read_failing_call(failing_call);
  ::alarm(600);  // it ends a copy that hangs
  this_process.is_running = true;
}

}  // namespace

int serve(Main* own_main, int argc, char** argv, char** environment) {
  this_process.is_running = false;
  const Counts begun = *this_process.counts;
  char line[8192];
  std::snprintf(line, sizeof line, "%llu\n", static_cast<unsigned long long>(begun.of[kAllocation]));
  const auto answer = next<ssize_t(int, const void*, std::size_t)>("write");
  answer(STDOUT_FILENO, line, std::strlen(line));
  while (read_line(line, sizeof line)) {
    char failing_call[64], process[16], place[4096];
    if (std::sscanf(line, "%63s %15s %4095s", failing_call, process, place) != 3) return 125;
    *this_process.counts = begun;
    const pid_t copy = ::fork();
    if (copy == 0) {
      take_request(failing_call, process, place);
      return own_main(argc, argv, environment);
    }
    int status = 0;
    ::waitpid(copy, &status, 0);
    std::snprintf(line, sizeof line, "%d\n", status);
    answer(STDOUT_FILENO, line, std::strlen(line));
  }
  return 0;
}
