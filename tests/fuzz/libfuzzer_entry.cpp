// The entry points that libFuzzer calls. They run the target after which the program is named: fuzz_TARGET.
#include <pthread.h>
#include <sanitizer/common_interface_defs.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdlib>

#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/lasting_child.h"

using remote_touch::fuzz::targets;

namespace {

constexpr time_t kMaxTime_s = 1;

void (*read_input)(std::string_view bytes) = nullptr;

// A child process may crash, hang and run out of memory, and its parent has to answer then. A child's failure
// is therefore no finding, and the child does not write one.
void be_quiet_in_children() {
  __sanitizer_set_death_callback(nullptr);
}

void on_too_long(int) {
  constexpr char kMessage[] = "not true: an input is read within 1 s of processor time\n";
  if (::write(STDERR_FILENO, kMessage, sizeof kMessage - 1) < 0) std::abort();
  std::abort();
}

// The limit is processor time, which other programs on the machine do not change. libFuzzer's own limit is by
// the clock. 0 means no limit.
void limit_time(time_t seconds) {
  const itimerval limit{{0, 0}, {seconds, 0}};
  ::setitimer(ITIMER_PROF, &limit, nullptr);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char*** arguments) {
  const std::string program = (*arguments)[0];
  const auto is_own = [&](const auto& target) {
    return program.ends_with(std::string("fuzz_") + target.name);
  };
  const auto found = std::find_if(targets().begin(), targets().end(), is_own);
  if (found == targets().end()) std::abort();
  read_input = found->read;
  std::signal(SIGPROF, on_too_long);
  static remote_touch::fuzz::LastingChild child;
  remote_touch::fuzz::run_in_child() = std::ref(child);
  return pthread_atfork(nullptr, nullptr, be_quiet_in_children);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  limit_time(kMaxTime_s);
  read_input({reinterpret_cast<const char*>(data), size});
  limit_time(0);
  return 0;
}
