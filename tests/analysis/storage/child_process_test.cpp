// Work in a separate process: its answer, its failure, and its end if it needs too much.
#include "analysis/storage/child_process.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <stdexcept>
#include <string>
#include <vector>

namespace remote_touch::child_process_test {
namespace {

constexpr ChildLimits kLimits{256u << 20, 1};

std::string failure_of(const std::function<std::string()>& work) {
  try {
    return "answered " + in_child(kLimits, work);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(ChildProcess, AnswersWithItsBytes) {
  EXPECT_EQ(in_child(kLimits, [] { return std::string(); }), "");
  const std::string bytes("a\0b\n", 4);
  EXPECT_EQ(in_child(kLimits, [&] { return bytes; }), bytes);
  const std::string more(10'000'000, 'x');  // more bytes than a pipe takes at once
  EXPECT_EQ(in_child(kLimits, [&] { return more; }), more);
}

TEST(ChildProcess, ChangesNothingHere) {
  int changed = 0;
  in_child(kLimits, [&] { return changed = 1, std::string(); });
  EXPECT_EQ(changed, 0);
}

TEST(ChildProcess, PassesOnTheErrorMessage) {
  EXPECT_EQ(failure_of([]() -> std::string { throw std::runtime_error("no such thing"); }), "no such thing");
}

TEST(ChildProcess, FailsIfItNeedsTooMuchMemory) {
  EXPECT_EQ(failure_of([] { return std::string(std::size_t{1} << 30, 'x').substr(0, 1); }),
            "it needs more than 256 MiB of memory");
}

TEST(ChildProcess, IsEndedIfItTakesTooLong) {
  EXPECT_EQ(failure_of([]() -> std::string {
              for (std::atomic<unsigned> i = 0;;) ++i;
            }),
            "it takes more than 1 s");
}

TEST(ChildProcess, FailsIfItEndsWithAnExitCode) {
  EXPECT_EQ(failure_of([]() -> std::string { ::_exit(3); }),
            "the process that reads it ended with exit code 3, before its answer");
}

TEST(ChildProcess, ReportsTheSignalOfACrash) {
  EXPECT_EQ(failure_of([]() -> std::string {
              std::raise(SIGSEGV);
              return {};
            }),
            "its reader ended with signal 11, perhaps out of memory");
}

}  // namespace
}  // namespace remote_touch::child_process_test
