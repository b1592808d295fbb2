#include "analysis/storage/other_processes.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/wait.h>
#include <unistd.h>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/hdf5_file.h"
#include "core/parameters/parameter.h"

namespace remote_touch {
namespace {

// The first byte that a child sends.
constexpr char kAnswer = 'a', kFailure = 'f', kNoMemory = 'm';

std::string all_from(int from) {
  std::string all;
  std::array<char, 65536> piece;
  for (;;) {
    const ssize_t size = ::read(from, piece.data(), piece.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return all;
    all.append(piece.data(), static_cast<std::size_t>(size));
  }
}

rlim_t address_space() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

void limit(int resource, rlim_t wanted) {
  rlimit now{};
  ::getrlimit(static_cast<__rlimit_resource>(resource), &now);
  now.rlim_cur = std::min(wanted, now.rlim_max);
  ::setrlimit(static_cast<__rlimit_resource>(resource), &now);
}

// Runs in the child: sends the result of the work, or its error, and ends the process.
[[noreturn]] void answer(int to, const ChildLimits& limits,
                         const std::function<std::string()>& work) noexcept {
  become_limited_child(limits);
  const auto send = [to](char kind, std::string_view text) {  // allocates nothing
    std::size_t done = 0;
    if (write_all(to, &kind, 1, done) != 0 || write_all(to, text.data(), text.size(), done) != 0) ::_exit(1);
  };
  try {
    send(kAnswer, work());
  } catch (const std::bad_alloc&) {
    send(kNoMemory, {});
  } catch (const std::exception& error) {
    send(kFailure, error.what());
  }
  ::_exit(0);
}

std::string end_of(pid_t child, const ChildLimits& limits) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  if (WIFEXITED(status))
    return "the process that reads it ended with exit code " + std::to_string(WEXITSTATUS(status)) +
           ", before its answer";
  if (WTERMSIG(status) == SIGXCPU) return "it takes more than " + std::to_string(limits.processor_s) + " s";
  return "its reader ended with signal " + std::to_string(WTERMSIG(status)) + ", perhaps out of memory";
}

bool is_special(const std::filesystem::path& target) {
  std::error_code unreachable;
  const auto there = std::filesystem::status(target, unreachable);
  return std::filesystem::exists(there) && !std::filesystem::is_regular_file(there);
}

[[noreturn]] void refuse_lock(const std::filesystem::path& target, int error) {
  throw InputError(target.string(), std::string("cannot be locked (") + std::strerror(error) +
                                        "): expected a file system whose locks work, or one without locks");
}

}  // namespace

ChildLimits limits_to_read(const std::filesystem::path& file, std::size_t memory_for_each_byte) {
  constexpr std::size_t kMinMemory = 512u << 20;
  std::error_code unreachable;  // the reader reports the reason
  const std::uintmax_t found = std::filesystem::file_size(file, unreachable);
  const std::size_t size = unreachable ? 0 : static_cast<std::size_t>(found);
  return {kMinMemory + memory_for_each_byte * size, 1 + static_cast<unsigned>(size >> 20)};
}

namespace {

// The descriptors of the locks that this process holds, plus one; 0: a free place. A lock lasts as long as
// any process has its descriptor, so a child closes them: it may live a little longer than its parent. If
// there are more locks than places, a child keeps the others. There is no mutex, because fork() may copy a
// locked one.
std::array<std::atomic<int>, 256> held_locks{};

void note_lock(int descriptor) {
  for (std::atomic<int>& place : held_locks)
    if (int none = 0; place.compare_exchange_strong(none, descriptor + 1)) return;
}

void close_lock(int descriptor) {
  for (std::atomic<int>& place : held_locks)
    if (int held = descriptor + 1; place.compare_exchange_strong(held, 0)) break;
  ::close(descriptor);
}

void close_locks_of_parent() {
  for (std::atomic<int>& place : held_locks)
    if (const int held = place.exchange(0); held > 0) ::close(held - 1);
}

}  // namespace

void become_limited_child(const ChildLimits& limits) {
  close_locks_of_parent();
  for (const int signal :
       {SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP})
    std::signal(signal, SIG_DFL);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  Hdf5Work::silence();
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.processor_s);
  limit(RLIMIT_AS, address_space() + limits.memory_bytes);
}

std::string in_child(const ChildLimits& limits, const std::function<std::string()>& work) {
  int ends[2];
  if (::pipe(ends) != 0) throw std::runtime_error(std::strerror(errno));
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    answer(ends[1], limits, work);
  }
  const int error = errno;
  ::close(ends[1]);
  std::string answered = child < 0 ? "" : all_from(ends[0]);
  ::close(ends[0]);
  if (child < 0) throw std::runtime_error(std::strerror(error));
  if (const std::string end = end_of(child, limits); !end.empty()) throw std::runtime_error(end);
  if (answered.empty())
    throw std::runtime_error("the process that reads it gave no answer, perhaps because memory ran out");
  const char kind = answered.front();
  answered.erase(0, 1);
  if (kind == kNoMemory)
    throw std::runtime_error("it needs more than " + std::to_string(limits.memory_bytes >> 20) +
                             " MiB of memory");
  if (kind == kFailure) throw std::runtime_error(answered);
  return answered;
}

std::string in_own_child(const ChildLimits& limits, ChildReader reader, const std::string& question) {
  return in_child(limits, [&] { return reader(question); });
}

int lock_error(int descriptor, int operation) {
  while (::flock(descriptor, operation) != 0)
    if (errno != EINTR) return errno;
  return 0;
}

bool has_no_locks(int error) {
  return error == ENOLCK || error == ENOSYS || error == EOPNOTSUPP || error == EINVAL;
}

FileLock::FileLock(const std::filesystem::path& target) : lock_(resolved(target).string() + ".lock") {
  require_writable(target);
  if (is_special(target)) return;
  // The last holder may have removed the file between our open and our lock. The name then belongs to another
  // file, or to none.
  do {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = ::open(lock_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) refuse_writing(target, errno, "a file in a writable folder");
    const int error = lock_error(descriptor_, LOCK_EX | LOCK_NB);
    if (error == 0) continue;
    if (has_no_locks(error)) return;
    ::close(descriptor_);
    if (error != EWOULDBLOCK) refuse_lock(target, error);
    throw InputError(target.string(), "another process is writing this file: expected one at a time");
  } while (!is_name_of(lock_, descriptor_));
  note_lock(descriptor_);
  try {
    remove_leftovers(target);
  } catch (...) {  // the destructor does not run for a constructor that throws
    release();
    throw;
  }
}

FileLock::FileLock(FileLock&& other) noexcept
    : lock_(std::move(other.lock_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

void FileLock::release() {
  if (descriptor_ < 0) return;
  ::unlink(lock_.c_str());
  close_lock(descriptor_);
}

FileLock::~FileLock() {
  release();
}

// /proc/locks has a line for each lock: "1: FLOCK  ADVISORY  WRITE 712 fe:00:1835069 0 EOF". The sixth word
// is the device, in hexadecimal digits, and the number of the file.
bool is_being_written(const std::filesystem::path& target) {
  struct stat there = {};
  if (::stat((resolved(target).string() + ".lock").c_str(), &there) != 0) return false;
  char name[64];
  std::snprintf(name, sizeof name, "%02x:%02x:%ju", ::major(there.st_dev), ::minor(there.st_dev),
                static_cast<std::uintmax_t>(there.st_ino));
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);)
    if (line.find(" FLOCK ") != std::string::npos &&
        line.find(std::string(" ") + name + " ") != std::string::npos)
      return true;
  return false;
}

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0) return;
  const int error = lock_error(descriptor_, LOCK_EX | LOCK_NB);
  if (error == 0 || has_no_locks(error)) {
    note_lock(descriptor_);
    return;
  }
  ::close(descriptor_);
  if (error != EWOULDBLOCK) refuse_lock(folder, error);
  throw InputError(folder.string(), "another process is writing there: expected one at a time");
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) close_lock(descriptor_);
}

}  // namespace remote_touch
