// The exchange of data between threads of the live loop. The tests are meant for the thread sanitizer, too.
#include <gtest/gtest.h>

#include <array>
#include <thread>

#include "runners/live/devices/clock.h"
#include "runners/live/loop/servo.h"

namespace remote_touch::live_exchange_test {
namespace {

constexpr int kValues = 200'000;

// A torn value would not hold the same number everywhere.
using Wide = std::array<int, 64>;

// Both sides yield instead of spinning, so that they alternate on a single free core, too.
TEST(TripleBuffer, GivesTheNewestWholeAndInOrder) {
  TripleBuffer<Wide> buffer;
  std::jthread producer([&](const std::stop_token& enough) {
    for (int i = 1; !enough.stop_requested(); ++i) {
      buffer.back().fill(i);
      buffer.publish();
      if (i % 16 == 0) std::this_thread::yield();
    }
  });
  int last = 0;
  for (int taken = 0; taken < kValues / 100;) {
    if (!buffer.take()) {
      std::this_thread::yield();
      continue;
    }
    const Wide& front = buffer.front();
    for (const int part : front) ASSERT_EQ(part, front[0]) << "torn";
    ASSERT_GT(front[0], last) << "reversed or repeated";
    last = front[0], ++taken;
  }
}

TEST(TripleBuffer, ReportsWhetherAValueWasOvertaken) {
  TripleBuffer<int> buffer;
  buffer.back() = 1;
  EXPECT_TRUE(buffer.publish());
  buffer.back() = 2;
  EXPECT_FALSE(buffer.publish());
  EXPECT_TRUE(buffer.take());
  EXPECT_EQ(buffer.front(), 2);
  EXPECT_FALSE(buffer.take());
  EXPECT_EQ(buffer.front(), 2);
  buffer.back() = 3;
  EXPECT_TRUE(buffer.publish());
}

TEST(Ring, HandsOverEveryValueInOrder) {
  Ring<Wide> ring(60);
  std::jthread producer([&](const std::stop_token& enough) {
    for (int i = 0; i < kValues && !enough.stop_requested();) {
      Wide* const next_slot = ring.next_slot();
      if (!next_slot) {
        std::this_thread::yield();
        continue;
      }
      next_slot->fill(i++);
      ring.push();
    }
  });
  for (int i = 0; i < kValues;) {
    const Wide* const oldest = ring.oldest();
    if (!oldest) {
      std::this_thread::yield();
      continue;
    }
    for (const int part : *oldest) ASSERT_EQ(part, i);
    ring.pop(), ++i;
  }
  producer.join();
  EXPECT_EQ(ring.oldest(), nullptr);
}

TEST(Ring, HasNoRoomWhenFull) {
  Ring<int> ring(4);
  for (int i = 0; i < 4; ++i) {
    ASSERT_NE(ring.next_slot(), nullptr);
    *ring.next_slot() = i;
    ring.push();
  }
  EXPECT_EQ(ring.next_slot(), nullptr);
  ring.pop();
  EXPECT_NE(ring.next_slot(), nullptr);
}

}  // namespace
}  // namespace remote_touch::live_exchange_test
