// Checks that the system can start the threads of OpenMP. If it cannot, the library would end the program.
#pragma once

namespace remote_touch {

inline constexpr int kMaxThreads = 4096;

// Sets the number of OpenMP's threads; 0: the number that OpenMP chooses, from OMP_NUM_THREADS or the
// processors. A child process starts the threads first, as a test. Throws InputError if there are more than
// kMaxThreads, or if the system refuses them. pre: OpenMP has not been used yet.
void use_threads(int wanted);

}  // namespace remote_touch
