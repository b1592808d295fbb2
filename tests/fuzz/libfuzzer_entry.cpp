// What libFuzzer calls: the one target that is linked.
#include <pthread.h>
#include <sanitizer/common_interface_defs.h>

#include <cstdint>

#include "core/parameters/input_error.h"
#include "tests/fuzz/fuzz_target.h"

using remote_touch::fuzz::targets;

// A child process may crash, hang and run out of memory: its parent has to answer then. So what a child does
// is no finding, and it does not write one.
static void be_quiet_in_children() {
  __sanitizer_set_death_callback(nullptr);
}

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  return pthread_atfork(nullptr, nullptr, be_quiet_in_children);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  targets().front().read({reinterpret_cast<const char*>(data), size});
  return 0;
}
