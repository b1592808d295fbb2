#include "runners/live/devices/clock.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>
#include <cstring>

namespace remote_touch {

namespace {

constexpr int kPriority = 80, kWatchPriority = 85;

int take_priority(int value) {
  sched_param priority{};
  priority.sched_priority = value;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
}

std::string outcome(const char* what, int error) {
  return std::string(what) +
         (error == 0 ? " granted" : std::string(" refused (") + std::strerror(error) + ")");
}

// Selects the last processor that the process may use, because most interrupts go to the first.
int pin_to_last_processor() {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return errno;
  int last = -1;
  for (int i = 0; i < CPU_SETSIZE; ++i)
    if (CPU_ISSET(i, &allowed)) last = i;
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(last, &one);
  return pthread_setaffinity_np(pthread_self(), sizeof one, &one);
}

}  // namespace

std::string become_real_time() {
  const int scheduled = take_priority(kPriority);
  const int locked = mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0 ? 0 : errno;
  return outcome("SCHED_FIFO", scheduled) + ", " + outcome("memory locking", locked) + ", " +
         outcome("a processor", pin_to_last_processor());
}

void outrank_the_loop() noexcept {
  take_priority(kWatchPriority);
}

}  // namespace remote_touch
