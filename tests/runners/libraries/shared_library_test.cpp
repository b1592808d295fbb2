#include "runners/libraries/shared_library.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace remote_touch::lasting_thread_test {
namespace {

std::thread::id id_of(LastingThread& thread) {
  std::thread::id id;
  thread.run([&] { id = std::this_thread::get_id(); });
  return id;
}

TEST(LastingThread, DoesAllThatItIsGivenInOneThreadOfItsOwn) {
  const auto thread = lasting_thread();
  const std::thread::id first = id_of(*thread);
  EXPECT_NE(first, std::this_thread::get_id());
  for (int i = 0; i < 100; ++i) EXPECT_EQ(id_of(*thread), first);
}

TEST(LastingThread, ThrowsWhatTheWorkThrowsAndContinues) {
  const auto thread = lasting_thread();
  EXPECT_THROW(thread->run([] { throw std::out_of_range("far"); }), std::out_of_range);
  int done = 0;
  thread->run([&] { done = 1; });
  EXPECT_EQ(done, 1);
}

// Threads that were given back are used again, and none ends.
TEST(LastingThread, FreeThreadsAreUsedAgain) {
  std::set<std::thread::id> used;
  for (int round = 0; round < 10; ++round) {
    const std::vector three = {lasting_thread(), lasting_thread(), lasting_thread()};
    std::set<std::thread::id> now;
    for (const auto& thread : three) now.insert(id_of(*thread));
    EXPECT_EQ(now.size(), 3u);
    used.merge(now);
  }
  EXPECT_EQ(used.size(), 3u);
}

}  // namespace
}  // namespace remote_touch::lasting_thread_test
