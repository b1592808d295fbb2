// Tests that fail, for timed_tests_check.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

namespace {

// Every thread of this process stands still, as when the machine pauses.
void stand_still(unsigned ms) {
  const pid_t self = ::getpid(), other = ::fork();
  if (other == 0) {
    ::kill(self, SIGSTOP);
    ::usleep(1000 * ms);
    ::kill(self, SIGCONT);
    ::_exit(0);
  }
  ::waitpid(other, nullptr, 0);
}

TEST(Example, FailsInTheFirstTryInWhichTheMachinePauses) {
  if (std::getenv("REMOTE_TOUCH_TRY")) return;
  ::usleep(20000);
  stand_still(50);
  ::usleep(20000);
  ADD_FAILURE();
}

TEST(Example, FailsWheneverTheMachinePauses) {
  stand_still(20);
  ADD_FAILURE();
}

TEST(Example, Fails) {
  ADD_FAILURE();
}

TEST(Example, Passes) {}

}  // namespace
