// Real-time settings that an ordinary Linux system offers.
#pragma once

#include <string>

namespace remote_touch {

// Requests SCHED_FIFO at priority 80 and a fixed processor for the calling thread, and locked memory for the
// process. None of them is required. Memory is locked page by page as it is used, because locking all at once
// would also commit the memory that reserve() only reserved. Returns one line: the requests granted, and why
// the others were not.
std::string become_real_time();

// Requests a higher priority for the calling thread, which monitors such a loop. It stays at its own priority
// if the request is refused.
void outrank_the_loop() noexcept;

}  // namespace remote_touch
