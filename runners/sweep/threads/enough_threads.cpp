#include "runners/sweep/threads/enough_threads.h"

#include <fcntl.h>
#include <omp.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <string>

#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

// Runs in the child process, which prints nothing and is ended after some seconds.
[[noreturn]] void start_threads() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGSEGV, SIGBUS, SIGABRT, SIGALRM})
    std::signal(signal, SIG_DFL);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::alarm(20);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  ::dup2(nowhere, STDOUT_FILENO), ::dup2(nowhere, STDERR_FILENO);
  std::atomic<int> started{0};
#pragma omp parallel
  ++started;
  ::_exit(started > 0 ? 0 : 1);
}

bool can_start_threads() {
  const pid_t child = ::fork();
  if (child == 0) start_threads();
  int status = 0;
  while (child > 0 && ::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

void use_threads(int wanted) {
  if (wanted > 0) omp_set_num_threads(wanted);
  const int threads = omp_get_max_threads();
  const std::string subject = (wanted > 0 ? "--threads = " : "OMP_NUM_THREADS = ") + std::to_string(threads);
  if (threads > kMaxThreads) throw InputError(subject, "expected 1 to " + std::to_string(kMaxThreads));
  if (threads > 1 && !can_start_threads())
    throw InputError(
        subject,
        "this number of threads cannot be started: expected fewer, or higher limits of processes "
        "and memory");
}

}  // namespace remote_touch
