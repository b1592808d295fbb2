// An unfinished recording may hold blocks that no recording has: they are left out, or the file is refused.
#include "runners/experiment/sessions/unfinished_session.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "runners/experiment/sessions/session_file.h"
#include "runners/experiment/sessions/session_recorder.h"
#include "tests/runners/experiment/sessions/small_session.h"
#include "tests/support/test_files.h"

namespace remote_touch::unfinished_session_test {
namespace {

namespace fs = std::filesystem;

std::string block_bytes(const TestFolder& folder, const std::vector<JournalBlock>& blocks) {
  fs::remove(folder / "made.unfinished");
  JournalWriter writer(folder / "made", blocks.front());
  for (std::size_t i = 1; i < blocks.size(); ++i) writer.append(blocks[i]);
  return bytes_of(writer.file());
}

JournalBlock block(SessionBlock kind, std::string content) {
  return {static_cast<std::uint32_t>(kind), std::move(content)};
}

SessionTick tick(std::int64_t number, int taken = -1) {
  SessionTick made;
  made.number = number, made.taken = taken;
  return made;
}

class UnfinishedSessionFile : public testing::Test {
 protected:
  const TestFolder folder_{"unfinished_session"};
  const SessionLayout layout_ = layout_of(SmallSession{}.view);
  const SmallSession session_{};

  JournalBlock start() const {
    return block(SessionBlock::start,
                 packed_start(layout_, session_attributes(session_.view, session_.registered,
                                                          {{"config", session_.config}}, {"renderer.r1_m"})));
  }
  JournalBlock frame(int number) const {
    SensorFrame made;
    made.number = number, made.depth.assign(6, 500);
    return block(SessionBlock::frame, packed_frame(stored_frame(layout_, made, number, 0)));
  }
  static JournalBlock ticks(const std::vector<SessionTick>& list) {
    return block(SessionBlock::ticks, packed_ticks(list, {}));
  }
  // A block of tick 4 with these changes.
  static JournalBlock changes(const std::vector<SessionChange>& list) {
    return block(SessionBlock::ticks, packed_ticks(std::vector<SessionTick>{tick(4)}, list));
  }
  // The last block follows a session of one frame and one tick. It is left out, as is everything after it.
  void expect_left_out(const JournalBlock& last) {
    const std::vector<JournalBlock> good{start(), frame(0), ticks({tick(3, 0)})};
    const std::size_t size = block_bytes(folder_, good).size();
    std::vector<JournalBlock> all = good;
    all.push_back(last), all.push_back(ticks({tick(9)}));
    const fs::path file = folder_.write("x", block_bytes(folder_, all));
    const UnfinishedSession found = recover_session(file, folder_ / "r.h5");
    EXPECT_EQ(found.ticks, 1u);
    EXPECT_EQ(found.frames, 1u);
    EXPECT_EQ(found.left_out_bytes, fs::file_size(file) - size);
    EXPECT_EQ(SessionReader(folder_ / "r.h5").tick_count(), 1u);
  }
};

TEST_F(UnfinishedSessionFile, LeavesOutBlocksThatNoRecordingHas) {
  expect_left_out(start());
  expect_left_out(frame(0));
  expect_left_out({77, "of another kind"});
  expect_left_out(ticks({tick(3)}));
  expect_left_out(ticks({tick(-1)}));
  expect_left_out(ticks({tick(std::int64_t{1} << 31)}));
  expect_left_out(ticks({tick(4, 0)}));
  expect_left_out(ticks({tick(4, 1)}));
  expect_left_out(ticks({tick(4, -2)}));
  expect_left_out(ticks({tick(5), tick(4)}));
  expect_left_out(block(SessionBlock::ticks, ""));
  expect_left_out(block(SessionBlock::ticks, std::string(16, '\xff')));
  expect_left_out(block(SessionBlock::ticks, ticks({tick(4)}).content + "x"));
  expect_left_out(block(SessionBlock::frame, ""));
  expect_left_out(block(SessionBlock::frame, frame(1).content + "x"));
  expect_left_out(block(SessionBlock::end, "x"));
  StoredFrame stored;
  stored.number = 1;
  expect_left_out(block(SessionBlock::frame, packed_frame(stored)));
  for (const std::size_t pixels : {0u, 5u, 7u, 1000000u}) {
    const std::vector<std::uint16_t> depth(pixels);
    stored.depth = deflated_row(depth.data(), pixels, 2);
    expect_left_out(block(SessionBlock::frame, packed_frame(stored)));
  }
  stored.depth = "no image";
  expect_left_out(block(SessionBlock::frame, packed_frame(stored)));
}

// SessionReader refuses such changes, so that a recording with them could not be read.
TEST_F(UnfinishedSessionFile, LeavesOutChangesThatNoRecordingHas) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  expect_left_out(changes({{5, 0, 0.1}, {4, 0, 0.1}}));
  expect_left_out(changes({{std::uint64_t{1} << 31, 0, 0.1}}));
  expect_left_out(changes({{4, 1, 0.1}}));
  expect_left_out(changes({{4, -1, 0.1}}));
  expect_left_out(changes({{4, 0, kInfinity}}));
}

TEST_F(UnfinishedSessionFile, KeepsTheTickInWhichTheDeviceFailed) {
  SessionTick failed = tick(4);
  failed.device.position_W.setConstant(std::nan(""));
  const std::vector<JournalBlock> all{start(), ticks({failed})};
  recover_session(folder_.write("x", block_bytes(folder_, all)), folder_ / "r.h5");
  ASSERT_EQ(SessionReader(folder_ / "r.h5").tick_count(), 1u);
  EXPECT_TRUE(std::isnan(SessionReader(folder_ / "r.h5").device(0).position_W.x()));
}

TEST_F(UnfinishedSessionFile, KeepsPossibleChanges) {
  const std::vector<JournalBlock> all{start(), changes({{4, 0, 0.1}, {4, 0, 0.2}})};
  const UnfinishedSession found =
      recover_session(folder_.write("x", block_bytes(folder_, all)), folder_ / "r.h5");
  EXPECT_EQ(found.changes, 2u);
  EXPECT_EQ(SessionReader(folder_ / "r.h5").changes().size(), 2u);
}

TEST_F(UnfinishedSessionFile, RefusesWhatIsNoSession) {
  const auto why = [&](const std::vector<JournalBlock>& blocks) {
    const fs::path file = folder_.write("x", block_bytes(folder_, blocks));
    return refusal([&] { recover_session(file, folder_ / "r.h5"); });
  };
  EXPECT_HAS(why({start()}), "x: holds no whole tick and no whole frame");
  EXPECT_HAS(why({frame(0), start()}), "x: damaged (its first block is not whole)");
  EXPECT_HAS(why({block(SessionBlock::start, "")}), "its first block is not whole");
  EXPECT_HAS(why({block(SessionBlock::start, start().content + "x")}), "its first block is not whole");
  SessionLayout layout = layout_;
  layout.width = 0;
  EXPECT_HAS(why({block(SessionBlock::start, packed_start(layout, {}))}), "its first block is not whole");
  layout.width = 70000;
  EXPECT_HAS(why({block(SessionBlock::start, packed_start(layout, {}))}), "its first block is not whole");
  EXPECT_HAS(why({block(SessionBlock::start, packed_start(layout_, {{"schema", "remote-touch-session/9"}}))}),
             "is of schema remote-touch-session/9: expected remote-touch-session/3");
  EXPECT_FALSE(fs::exists(folder_ / "r.h5"));
  const std::string opening(kJournalOpening);
  const auto refused = [&](const std::string& bytes) {
    return refusal([&] { recover_session(folder_.write("x", bytes), folder_ / "r.h5"); });
  };
  EXPECT_HAS(refused(""), "x: is not an unfinished recording");
  EXPECT_HAS(refused(opening), "its first block is not whole");
  EXPECT_HAS(refused(opening + std::string(1000, '\x5a')), "its first block is not whole");
}

TEST_F(UnfinishedSessionFile, IsNotRecoveredWhileItIsRecorded) {
  SessionRecorder recorder(folder_ / "x.h5", session_.view, session_.registered,
                           {{"config", session_.config}});
  for (int i = 0; i < 100; ++i) recorder.append(tick(i));
  EXPECT_TRUE(read_unfinished(folder_ / "x.h5.unfinished").is_growing);
  EXPECT_HAS(refusal([&] { recover_session(folder_ / "x.h5.unfinished", folder_ / "r.h5"); }),
             "x.h5.unfinished: is being recorded");
}

TEST_F(UnfinishedSessionFile, IsNamedByTheReaderOfSessions) {
  { SessionRecorder(folder_ / "x.h5", session_.view, session_.registered, {}).append(tick(0)); }
  EXPECT_HAS(refusal([&] { SessionReader(folder_ / "x.h5.unfinished"); }), "is an unfinished recording");
  EXPECT_HAS(refusal([&] { SessionReader(folder_ / "x.h5"); }), "its unfinished recording is there");
}

}  // namespace
}  // namespace remote_touch::unfinished_session_test
