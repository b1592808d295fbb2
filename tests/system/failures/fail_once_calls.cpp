// The functions of the system that count and may fail, see fail_once.cpp.
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "fail_once.h"

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
}

namespace {

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

Main* own_main = nullptr;

int begin(int argc, char** argv, char** environment) {
  return std::getenv("FAIL_ONCE_SERVER") ? serve(own_main, argc, argv, environment)
                                         : own_main(argc, argv, environment);
}

}  // namespace

extern "C" {

int __libc_start_main(Main* entry, int argc, char** argv, void (*init)(), void (*fini)(), void (*loader)(),
                      void* stack) {
  this_process.is_running = true;
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

// The file is closed either way. A file that was only read cannot be lost, so its call never fails.
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
