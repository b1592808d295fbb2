// Preloaded into a program, counts what it asks of the system, and fails the n-th call of one kind, once:
//
//   LD_PRELOAD=libfail_once.so FAIL_ONCE_BELOW=/folder FAIL_ONCE_COUNTS=/file FAIL_ONCE=write:3:ENOSPC
//   remote-touch ...
//
// FAIL_ONCE is KIND:N:HOW. How: ENOSPC, EIO, ENOMEM, or KILL, which ends the process with SIGKILL before the
// call. Without FAIL_ONCE it only counts. Files count only below the folder, allocations from the begin of
// the program's own code (not in the loader, nor in the constructors of libraries). FAIL_ONCE_COUNTS is a
// file of 4096 zeros, which the program shares with all processes that it starts: the numbers of Counts. With
// FAIL_ONCE_PROCESS=2 only the second of them to begin counts and fails. FAIL_ONCE_SITES is a file for the
// allocations that are the first of their call stack, since most repeat others: number and hash of the stack.
// FAIL_ONCE_TRACE is a file for the stack at the failure.
//
// With FAIL_ONCE_SERVER it does not begin, but answers requests on stdin, so that the loader has its work
// once only. A request is a line "KIND:N:HOW PROCESS FOLDER" (PROCESS 0: any); a copy of the program then
// runs in FOLDER/work with its output in FOLDER/out and FOLDER/err, and the answer is a line with its status,
// as of waitpid(). The first line of all is how many allocations there were until then: those fail in no
// copy.
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
}

namespace {

enum Kind { kAllocation, kOpen, kWrite, kFlush, kRename, kTruncate, kRemove, kClose, kKindCount };
constexpr const char* kKinds[kKindCount] = {"allocation", "open",     "write",  "flush",
                                            "rename",     "truncate", "remove", "close"};
constexpr int kKill = -1;

struct Counts {
  std::uint64_t of[kKindCount];
  std::uint64_t failed;
  std::uint64_t processes;
};
constexpr std::size_t kMaxSites = 1 << 16;
constexpr int kFrames = 8;       // innermost ones, which make a stack
std::uint64_t sites[kMaxSites];  // hashes of call stacks; 0: none
Counts private_counts;
Counts* counts = &private_counts;
char folder[4096];
std::size_t folder_size = 0;
int failing_kind = -1, failing_errno = 0, trace = -1, new_sites = -1;
std::uint64_t failing_call = 0;
bool is_running = false;  // the program's own code
bool is_chosen = true;    // the process

int errno_of(const char* name) {
  if (std::strcmp(name, "KILL") == 0) return kKill;
  if (std::strcmp(name, "ENOSPC") == 0) return ENOSPC;
  return std::strcmp(name, "ENOMEM") == 0 ? ENOMEM : EIO;
}

void read_wish(const char* text) {
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

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

__attribute__((constructor)) void prepare() {
  if (const char* below = std::getenv("FAIL_ONCE_BELOW")) {
    std::snprintf(folder, sizeof folder, "%s/", below);
    folder_size = std::strlen(folder);
  }
  if (const char* file = std::getenv("FAIL_ONCE_COUNTS")) {
    const int shared = next<int(const char*, int, ...)>("open")(file, O_RDWR | O_CLOEXEC);
    void* const there =
        shared < 0 ? MAP_FAILED : ::mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, shared, 0);
    if (there != MAP_FAILED) counts = static_cast<Counts*>(there);
  }
  const std::uint64_t process = __atomic_add_fetch(&counts->processes, 1, __ATOMIC_RELAXED);
  if (const char* only = std::getenv("FAIL_ONCE_PROCESS"))
    is_chosen = process == std::strtoull(only, nullptr, 10);
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
  if (const char* wish = std::getenv("FAIL_ONCE")) read_wish(wish);
}

// Of the return addresses, relative to the libraries that they are in.
std::uint64_t hash_of_stack() {
  void* stack[kFrames + 3];
  const int depth = ::backtrace(stack, kFrames + 3);
  std::uint64_t hash = 1469598103934665603U;
  for (int i = 3; i < depth; ++i) {  // from whoever called this library
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

// Counts a call. True if it is the one that fails; errno is then set.
bool fails(Kind kind) {
  if (!is_running || !is_chosen) return false;
  const std::uint64_t call = __atomic_add_fetch(&counts->of[kind], 1, __ATOMIC_RELAXED);
  if (new_sites >= 0 && kind == kAllocation) note_site(call);
  if (kind != failing_kind || call != failing_call) return false;
  __atomic_add_fetch(&counts->failed, 1, __ATOMIC_RELAXED);
  if (trace >= 0) {
    void* stack[64];
    ::backtrace_symbols_fd(stack, ::backtrace(stack, 64), trace);
  }
  if (failing_errno == kKill) ::kill(::getpid(), SIGKILL);
  errno = failing_errno;
  return true;
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
template <class Place>
bool fails_below(Kind kind, Place place) {
  const int before = errno;
  const bool counted = folder_size > 0 && is_below(place);
  errno = before;
  return counted && fails(kind);
}

bool writes(int flags) {
  return (flags & O_ACCMODE) != O_RDONLY || (flags & O_CREAT) != 0;
}
bool writes(const char* mode) {
  return std::strpbrk(mode, "wa+") != nullptr;
}

bool is_written(int file) {
  const int before = errno, flags = ::fcntl(file, F_GETFL);
  errno = before;
  return flags >= 0 && (flags & O_ACCMODE) != O_RDONLY;
}

mode_t mode_after(int flags, va_list list) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(list, mode_t) : 0;
}

using Main = int(int, char**, char**);
Main* own_main = nullptr;

bool read_line(char* line, std::size_t room) {
  std::size_t size = 0;
  while (size + 1 < room && ::read(STDIN_FILENO, line + size, 1) == 1 && line[size] != '\n') ++size;
  const bool whole = line[size] == '\n';
  line[size] = '\0';
  return whole;
}

void redirect(int stream, const char* place, const char* name, int flags) {
  char path[4096];
  std::snprintf(path, sizeof path, "%s%s", place, name);
  const int file = next<int(const char*, int, ...)>("open")(path, flags | O_CLOEXEC, 0666);
  ::dup2(file, stream);
}

void set_below(const char* name, const char* place, const char* below) {
  char path[4096];
  std::snprintf(path, sizeof path, "%s%s", place, below);
  ::setenv(name, path, 1);
}

// In the copy.
void take_request(const char* wish, const char* process, const char* place) {
  redirect(STDIN_FILENO, "/dev/null", "", O_RDONLY);
  redirect(STDOUT_FILENO, place, "/out", O_WRONLY | O_CREAT | O_TRUNC);
  redirect(STDERR_FILENO, place, "/err", O_WRONLY | O_CREAT | O_TRUNC);
  set_below("FAIL_ONCE_BELOW", place, "/work");
  set_below("TMPDIR", place, "/work/tmp");
  set_below("REMOTE_TOUCH_CACHE", place, "/work/cache");
  ::unsetenv("FAIL_ONCE_SERVER");
  ::setenv("FAIL_ONCE", wish, 1);
  if (std::strcmp(process, "0") != 0) ::setenv("FAIL_ONCE_PROCESS", process, 1);
  std::snprintf(folder, sizeof folder, "%s/work/", place);
  folder_size = std::strlen(folder);
  if (::chdir(folder) != 0) ::_exit(125);
  is_chosen = std::strcmp(process, "0") == 0 || std::strcmp(process, "1") == 0;
  read_wish(wish);
  ::alarm(60);  // what does not end
  is_running = true;
}

int serve(int argc, char** argv, char** environment) {
  is_running = false;
  const Counts begun = *counts;
  char line[8192];
  std::snprintf(line, sizeof line, "%llu\n", static_cast<unsigned long long>(begun.of[kAllocation]));
  const auto answer = next<ssize_t(int, const void*, std::size_t)>("write");
  answer(STDOUT_FILENO, line, std::strlen(line));
  while (read_line(line, sizeof line)) {
    char wish[64], process[16], place[4096];
    if (std::sscanf(line, "%63s %15s %4095s", wish, process, place) != 3) return 125;
    *counts = begun;
    const pid_t copy = ::fork();
    if (copy == 0) {
      take_request(wish, process, place);
      return own_main(argc, argv, environment);
    }
    int status = 0;
    ::waitpid(copy, &status, 0);
    std::snprintf(line, sizeof line, "%d\n", status);
    answer(STDOUT_FILENO, line, std::strlen(line));
  }
  return 0;
}

int begin(int argc, char** argv, char** environment) {
  return std::getenv("FAIL_ONCE_SERVER") ? serve(argc, argv, environment) : own_main(argc, argv, environment);
}

}  // namespace

extern "C" {

int __libc_start_main(Main* entry, int argc, char** argv, void (*init)(), void (*fini)(), void (*loader)(),
                      void* stack) {
  is_running = true;
  own_main = entry;
  return next<int(Main*, int, char**, void (*)(), void (*)(), void (*)(), void*)>("__libc_start_main")(
      begin, argc, argv, init, fini, loader, stack);
}

void* malloc(std::size_t size) noexcept {
  return fails(kAllocation) ? nullptr : __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  return fails(kAllocation) ? nullptr : __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) noexcept {
  return fails(kAllocation) ? nullptr : __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return fails(kAllocation) ? nullptr : __libc_memalign(alignment, size);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  return fails(kAllocation) ? nullptr : __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  if (fails(kAllocation)) return ENOMEM;
  void* const found = __libc_memalign(alignment, size);
  if (!found) return ENOMEM;
  *memory = found;
  return 0;
}

#define OPENS(name)                                                    \
  int name(const char* path, int flags, ...) {                         \
    va_list list;                                                      \
    va_start(list, flags);                                             \
    const mode_t mode = mode_after(flags, list);                       \
    va_end(list);                                                      \
    if (writes(flags) && fails_below(kOpen, path)) return -1;          \
    return next<int(const char*, int, ...)>(#name)(path, flags, mode); \
  }
OPENS(open)
OPENS(open64)
#undef OPENS

#define OPENS_STREAM(name)                                           \
  FILE* name(const char* path, const char* mode) {                   \
    if (writes(mode) && fails_below(kOpen, path)) return nullptr;    \
    return next<FILE*(const char*, const char*)>(#name)(path, mode); \
  }
OPENS_STREAM(fopen)
OPENS_STREAM(fopen64)
#undef OPENS_STREAM

int mkstemp(char* path) {
  return fails_below(kOpen, path) ? -1 : next<int(char*)>("mkstemp")(path);
}
int mkstemp64(char* path) {
  return fails_below(kOpen, path) ? -1 : next<int(char*)>("mkstemp64")(path);
}
char* mkdtemp(char* path) noexcept {
  return fails_below(kOpen, path) ? nullptr : next<char*(char*)>("mkdtemp")(path);
}
int mkdir(const char* path, mode_t mode) noexcept {
  return fails_below(kOpen, path) ? -1 : next<int(const char*, mode_t)>("mkdir")(path, mode);
}

ssize_t write(int file, const void* data, std::size_t size) {
  return fails_below(kWrite, file) ? -1
                                   : next<ssize_t(int, const void*, std::size_t)>("write")(file, data, size);
}
ssize_t pwrite(int file, const void* data, std::size_t size, off_t at) {
  return fails_below(kWrite, file)
             ? -1
             : next<ssize_t(int, const void*, std::size_t, off_t)>("pwrite")(file, data, size, at);
}
ssize_t pwrite64(int file, const void* data, std::size_t size, off64_t at) {
  return fails_below(kWrite, file)
             ? -1
             : next<ssize_t(int, const void*, std::size_t, off64_t)>("pwrite64")(file, data, size, at);
}
ssize_t writev(int file, const iovec* data, int count) {
  return fails_below(kWrite, file) ? -1 : next<ssize_t(int, const iovec*, int)>("writev")(file, data, count);
}

int fsync(int file) {
  return fails_below(kFlush, file) ? -1 : next<int(int)>("fsync")(file);
}
int fdatasync(int file) {
  return fails_below(kFlush, file) ? -1 : next<int(int)>("fdatasync")(file);
}

int rename(const char* from, const char* to) noexcept {
  return fails_below(kRename, from) ? -1 : next<int(const char*, const char*)>("rename")(from, to);
}
int link(const char* from, const char* to) noexcept {
  return fails_below(kRename, from) ? -1 : next<int(const char*, const char*)>("link")(from, to);
}

int ftruncate(int file, off_t size) noexcept {
  return fails_below(kTruncate, file) ? -1 : next<int(int, off_t)>("ftruncate")(file, size);
}
int ftruncate64(int file, off64_t size) noexcept {
  return fails_below(kTruncate, file) ? -1 : next<int(int, off64_t)>("ftruncate64")(file, size);
}

int unlink(const char* path) noexcept {
  return fails_below(kRemove, path) ? -1 : next<int(const char*)>("unlink")(path);
}
int remove(const char* path) noexcept {
  return fails_below(kRemove, path) ? -1 : next<int(const char*)>("remove")(path);
}

// The file is closed either way. What was only read cannot be lost.
int close(int file) {
  const bool failed = is_written(file) && fails_below(kClose, file);
  const int error = errno;
  const int result = next<int(int)>("close")(file);
  if (!failed) return result;
  errno = error;
  return -1;
}
int fclose(FILE* file) {
  const bool failed = is_written(::fileno(file)) && fails_below(kClose, ::fileno(file));
  const int error = errno;
  const int result = next<int(FILE*)>("fclose")(file);
  if (!failed) return result;
  errno = error;
  return EOF;
}

}  // extern "C"
