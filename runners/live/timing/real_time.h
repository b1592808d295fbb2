// Real-time settings that an ordinary Linux system offers.
#pragma once

#include <string>

namespace remote_touch {

// For the calling thread: requests SCHED_FIFO at priority 80, a fixed processor, and locked memory; none is
// required. Memory is locked page by page as it is used, because locking all at once would also commit what
// reserve() only reserved. Returns one line: what was granted, and why the rest was not.
std::string become_real_time();

// For a thread that monitors such a loop: a higher priority and any processor, if permitted.
void outrank_the_loop() noexcept;

}  // namespace remote_touch
