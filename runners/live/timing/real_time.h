// What an ordinary system gives to a loop that must not be late.
#pragma once

#include <string>

namespace remote_touch {

// For the calling thread: SCHED_FIFO at priority 80, its processor, and memory that stays. Each is asked for
// and none is required. Memory is locked page by page as it is used: locking all at once would hold what
// reserve() only set aside. Returns a line that tells what was given, and why the rest was not.
std::string become_real_time();

// For a thread that watches such a loop: a higher priority and any processor, where that is permitted.
void outrank_the_loop() noexcept;

}  // namespace remote_touch
