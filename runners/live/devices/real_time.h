// Real-time settings that an ordinary Linux system offers.
#pragma once

#include <string>

namespace remote_touch {

// Requests SCHED_FIFO at priority 80, a fixed processor, and locked memory for the calling thread; none is
// required. Memory is locked page by page as it is used, because locking all at once would also commit the
// memory that reserve() only reserved. Returns one line: the requests granted, and why the others were not.
std::string become_real_time();

// Gives the calling thread, which monitors such a loop, a higher priority and any processor, if permitted.
void outrank_the_loop() noexcept;

}  // namespace remote_touch
