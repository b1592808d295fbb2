// Checks that the system can start the threads of OpenMP. If it cannot, the library would end the program.
#pragma once

namespace remote_touch {

inline constexpr int kMaxThreads = 4096;

// Sets the number of OpenMP's threads (0: as it decides, by OMP_NUM_THREADS or the processors), and lets a
// child process start them first. Throws InputError where they are more than kMaxThreads or the system
// refuses them. pre: OpenMP was not at work yet.
void use_threads(int wanted);

}  // namespace remote_touch
