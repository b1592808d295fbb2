// Helper of tests that use another library instead of the system's library of the same name.
#pragma once

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace remote_touch {

// Starts the program again, once, with this folder before the others, because the loader reads
// LD_LIBRARY_PATH only when a program starts. It works both from ctest and by hand.
inline void start_with_libraries(const std::string& folder, char** argv) {
  const char* variable = std::getenv("LD_LIBRARY_PATH");
  const std::string others = variable ? variable : "";
  if (others.rfind(folder, 0) == 0) return;
  setenv("LD_LIBRARY_PATH", (others.empty() ? folder : folder + ":" + others).c_str(), 1);
  execv("/proc/self/exe", argv);
  std::perror("cannot start again");
  std::exit(1);
}

}  // namespace remote_touch
