#include "analysis/storage/child_process.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string_view>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/hdf5_file.h"

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

}  // namespace

ChildLimits limits_to_read(const std::filesystem::path& file, std::size_t memory_for_each_byte) {
  constexpr std::size_t kMinMemory = 512u << 20;
  std::error_code unreachable;  // the reader reports the reason
  const std::uintmax_t found = std::filesystem::file_size(file, unreachable);
  const std::size_t size = unreachable ? 0 : static_cast<std::size_t>(found);
  return {kMinMemory + memory_for_each_byte * size, 1 + static_cast<unsigned>(size >> 20)};
}

void become_limited_child(const ChildLimits& limits) {
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

}  // namespace remote_touch
