// This library is preloaded into a program. It counts the program's calls to the system, and makes the n-th
// call of one kind fail, once:
//
//   LD_PRELOAD=libfail_once.so FAIL_ONCE_BELOW=/folder FAIL_ONCE_COUNTS=/file FAIL_ONCE=write:3:ENOSPC
//   remote-touch ...
//
// FAIL_ONCE is KIND:N:HOW. HOW is ENOSPC, EIO, ENOMEM, or KILL, which ends the process with SIGKILL before
// the call. If FAIL_ONCE is not set, the library only counts. Files count only below the folder. Allocations
// count from the beginning of the program's own code (not in the loader, nor in the constructors of
// libraries). FAIL_ONCE_COUNTS is a file of 4096 zeros for the numbers of Counts, which the program shares
// with all processes that it starts. FAIL_ONCE_PROCESS=2 lets only the second of these processes count and
// fail. FAIL_ONCE_SITES is a file for the allocations that are the first of their call stack, since most
// repeat others. It receives the number of the call and the hash of the stack. FAIL_ONCE_TRACE is a file for
// the stack at the failure.
//
// If FAIL_ONCE_SERVER is set, the program does not begin, but answers requests on stdin, so that the loader
// does its work only once. A request is a line "KIND:N:HOW PROCESS FOLDER" (PROCESS 0 means any). A copy of
// the program then runs in FOLDER/made with its output in FOLDER/out and FOLDER/err, and the answer is a line
// with its status, as of waitpid(). The first line of all states how many allocations there were until then.
// These allocations fail in no copy.
#include "fail_once.h"

#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

Process this_process;

namespace {

constexpr const char* kKinds[kKindCount] = {"allocation", "open",     "write",  "flush",
                                            "rename",     "truncate", "remove", "close"};
constexpr int kKill = -1;

constexpr std::size_t kMaxSites = 1 << 16;
constexpr int kFrames = 8;       // number of innermost frames that identify a stack
std::uint64_t sites[kMaxSites];  // hashes of call stacks; 0: none
char folder[4096];
std::size_t folder_size = 0;
int failing_kind = -1, failing_errno = 0, trace = -1, new_sites = -1;
std::uint64_t failing_call = 0;

int errno_of(const char* name) {
  if (std::strcmp(name, "KILL") == 0) return kKill;
  if (std::strcmp(name, "ENOSPC") == 0) return ENOSPC;
  return std::strcmp(name, "ENOMEM") == 0 ? ENOMEM : EIO;
}

// Returns a hash of the return addresses, each relative to the library that it is in.
std::uint64_t hash_of_stack() {
  void* stack[kFrames + 3];
  const int depth = ::backtrace(stack, kFrames + 3);  // includes this library's frames
  std::uint64_t hash = 1469598103934665603U;
  for (int i = 1; i < depth; ++i) {
    dl_find_object object{};
    const bool known = ::_dl_find_object(stack[i], &object) == 0;
    const auto base = reinterpret_cast<std::uintptr_t>(known ? object.dlfo_map_start : nullptr);
    hash = (hash ^ (reinterpret_cast<std::uintptr_t>(stack[i]) - base)) * 1099511628211U;
  }
  return hash | 1;
}

void note_site(std::uint64_t call) {
  const std::uint64_t hash = hash_of_stack();
  std::size_t place = hash >> 20;
  while (sites[place % kMaxSites] != 0 && sites[place % kMaxSites] != hash) ++place;
  if (sites[place % kMaxSites] == hash) return;
  sites[place % kMaxSites] = hash;
  const std::uint64_t site[] = {call, hash};
  next<ssize_t(int, const void*, std::size_t)>("write")(new_sites, site, sizeof site);
}

bool is_below(const char* path) {
  if (path[0] == '/') return std::strncmp(path, folder, folder_size) == 0;
  char here[4096];
  if (!::getcwd(here, sizeof here - 1)) return false;
  std::strcat(here, "/");
  return std::strncmp(here, folder, folder_size) == 0;
}
bool is_below(int file) {
  char link[64], target[4096];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t size = ::readlink(link, target, sizeof target - 1);
  if (size < 0) return false;
  target[size] = '\0';
  return target[0] == '/' && is_below(target);
}
}  // namespace

void read_failing_call(const char* text) {
  for (int kind = 0; kind < kKindCount; ++kind) {
    const std::size_t size = std::strlen(kKinds[kind]);
    if (std::strncmp(text, kKinds[kind], size) == 0 && text[size] == ':') {
      char* end = nullptr;
      failing_call = std::strtoull(text + size + 1, &end, 10);
      failing_errno = errno_of(*end == ':' ? end + 1 : "");
      failing_kind = kind;
    }
  }
}

void count_below(const char* place, const char* below) {
  std::snprintf(folder, sizeof folder, "%s%s/", place, below);
  folder_size = std::strlen(folder);
}

bool fails(Kind kind) {
  if (!this_process.is_running || !this_process.is_chosen) return false;
  const std::uint64_t call = __atomic_add_fetch(&this_process.counts->of[kind], 1, __ATOMIC_RELAXED);
  if (new_sites >= 0 && kind == kAllocation) note_site(call);
  if (kind != failing_kind || call != failing_call) return false;
  __atomic_add_fetch(&this_process.counts->failed, 1, __ATOMIC_RELAXED);
  if (trace >= 0) {
    void* stack[64];
    ::backtrace_symbols_fd(stack, ::backtrace(stack, 64), trace);
  }
  if (failing_errno == kKill) ::kill(::getpid(), SIGKILL);
  errno = failing_errno;
  return true;
}

namespace {

template <class Place>
bool fails_at(Kind kind, Place place) {
  const int before = errno;
  const bool counted = folder_size > 0 && is_below(place);
  errno = before;
  return counted && fails(kind);
}

__attribute__((constructor)) void prepare() {
  if (const char* below = std::getenv("FAIL_ONCE_BELOW")) count_below(below, "");
  if (const char* file = std::getenv("FAIL_ONCE_COUNTS")) {
    const int shared = next<int(const char*, int, ...)>("open")(file, O_RDWR | O_CLOEXEC);
    void* const there =
        shared < 0 ? MAP_FAILED : ::mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, shared, 0);
    // The test would find that no call failed, and pass, without the shared counts.
    if (there == MAP_FAILED) {
      std::fprintf(stderr, "fail_once: %s cannot be mapped\n", file);
      ::_exit(125);
    }
    this_process.counts = static_cast<Counts*>(there);
  }
  const std::uint64_t process = __atomic_add_fetch(&this_process.counts->processes, 1, __ATOMIC_RELAXED);
  if (const char* only = std::getenv("FAIL_ONCE_PROCESS"))
    this_process.is_chosen = process == std::strtoull(only, nullptr, 10);
  if (const char* file = std::getenv("FAIL_ONCE_TRACE")) {
    void* stack[1];
    ::backtrace(stack, 1);  // it allocates at its first call
    trace = next<int(const char*, int, ...)>("open")(file, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  }
  if (const char* file = std::getenv("FAIL_ONCE_SITES")) {
    void* stack[1];
    ::backtrace(stack, 1);
    new_sites =
        next<int(const char*, int, ...)>("open")(file, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  }
  if (const char* failing_call = std::getenv("FAIL_ONCE")) read_failing_call(failing_call);
}

}  // namespace

bool fails_below(Kind kind, const char* path) {
  return fails_at(kind, path);
}
bool fails_below(Kind kind, int file) {
  return fails_at(kind, file);
}
