// The part that the files of the preloaded library share. The file fail_once.cpp describes its purpose.
#pragma once

#include <dlfcn.h>
#include <sys/types.h>

#include <cstdint>

enum Kind { kAllocation, kOpen, kWrite, kFlush, kRename, kTruncate, kRemove, kClose, kKindCount };

struct Counts {
  std::uint64_t of[kKindCount];
  std::uint64_t failed;
  std::uint64_t processes;
};

// The process that this library is in.
struct Process {
  Counts private_counts = {};
  Counts* counts = &private_counts;
  bool is_running = false;  // true: it runs the program's own code
  bool is_chosen = true;
};
extern Process this_process;

// Reads which call is to fail, KIND:N:HOW.
void read_failing_call(const char* text);
// Counts the files below PLACE + below from now on.
void count_below(const char* place, const char* below);

// Counts a call. Returns true if it is the call that fails; errno is then set.
bool fails(Kind kind);
// Does the same for a path or an open file below the folder. If the call does not fail, errno keeps its
// value.
bool fails_below(Kind kind, const char* path);
bool fails_below(Kind kind, int file);

// Returns the function of this name that this library replaces.
template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

using Main = int(int, char**, char**);
// Answers requests with copies of the program, if FAIL_ONCE_SERVER is set; see fail_once.cpp.
int serve(Main* own_main, int argc, char** argv, char** environment);
