// Recordings that do not come to their end: they can be read up to their last whole block, and are then, row
// by row, the beginning of the whole recording.
#include "runners/experiment/sessions/session_file.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstring>
#include <limits>
#include <new>
#include <random>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "tests/runners/experiment/sessions/small_session.h"
#include "tests/support/test_files.h"

namespace remote_touch::session_recorder_test {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kParameters{"renderer.r1_m", "scenario.noise_per_m"};

SessionTick tick(std::int64_t number, int taken = -1) {
  SessionTick made;
  made.number = number, made.taken = taken;
  return made;
}

// A session with ticks that are all different, a frame for every 33 of them, taken 5 ticks after it came, and
// a change of a parameter now and then.
struct Recorded {
  SmallSession session;
  std::vector<SessionChange> changes;
  static constexpr int kTicksOfAFrame = 33;

  Recorded(int ticks, SensorView view) {
    session.view = view;
    std::mt19937_64 random(1);
    const auto number = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
    for (int i = 0; i < ticks; ++i) {
      if (i % kTicksOfAFrame == 0) add_frame(i / kTicksOfAFrame, random);
      SessionTick made = tick(i + i / 50, i % kTicksOfAFrame == 5 ? i / kTicksOfAFrame : -1);
      made.device = {{number(), number(), number()},
                     {number(), number(), number(), number()},
                     static_cast<std::uint32_t>(random())};
      made.written = {{number(), number(), number()}, {number(), number(), number()}};
      made.gate = i % 4;
      session.ticks.push_back(made);
      if (i % 70 == 69) changes.push_back({static_cast<std::uint64_t>(made.number), i % 2, number()});
    }
  }

  void add_frame(int number, std::mt19937_64& random) {
    SensorFrame frame;
    frame.number = number;
    const CameraIntrinsics& camera = session.view.camera;
    if (session.view.cloud) {
      for (std::size_t i = 0; i < session.view.cloud->numbers_per_point() * (number % 4); ++i)
        frame.points.push_back(static_cast<float>(random()));
    } else {
      for (int i = 0; i < camera.width * camera.height; ++i)
        frame.depth.push_back(static_cast<std::uint16_t>(random()));
    }
    const std::size_t colours =
        session.view.cloud ? static_cast<std::size_t>(number % 4) : frame.depth.size();
    for (std::size_t i = 0; session.view.has_colour && i < colours; ++i)
      frame.colour.push_back(static_cast<std::uint32_t>(random()));
    session.frames.push_back(frame), session.captured_s.push_back(0.033 * number);
    session.fixtures_off.push_back(random());
  }

  TextAttributes provenance() const {
    return {{"config", session.config}, {"command", "a \xff byte\nand a line"}};
  }

  // Calls done(ticks, frames) after each tick, with the numbers appended so far.
  template <class Done>
  void fill(SessionRecorder& recorder, const Done& done) const {
    std::size_t change = 0, frame = 0;
    for (std::size_t i = 0; i < session.ticks.size(); ++i) {
      if (i % kTicksOfAFrame == 0) {
        recorder.append(session.frames[frame], session.captured_s[frame], session.fixtures_off[frame]);
        ++frame;
      }
      const auto number = static_cast<std::uint64_t>(session.ticks[i].number);
      while (change < changes.size() && changes[change].tick == number) recorder.append(changes[change++]);
      recorder.append(session.ticks[i]);
      done(i + 1, frame);
    }
  }
  SessionRecorder recorder(const fs::path& file) const {
    return SessionRecorder(file, session.view, session.registered, provenance(), kParameters);
  }

  // Returns the whole recording, written without a journal.
  Hdf5Content whole(const TestFolder& folder) const {
    SessionWriter writer(folder / "whole.h5", session.view, session.registered, provenance(), kParameters);
    session.fill(writer);
    for (const SessionChange& change : changes) writer.append(change);
    writer.finish();
    return read_hdf5(folder / "whole.h5");
  }
};

SensorView images() {
  SensorView view = SmallSession{}.view;
  view.camera.width = 16, view.camera.height = 12, view.has_colour = true;
  return view;
}
SensorView clouds() {
  SensorView view = SmallSession{}.view;
  view.cloud = CloudLayout{true, 0, 10};
  view.has_colour = true;
  return view;
}

std::size_t rows_of(const Hdf5Content& content, const std::string& path) {
  for (const auto& [name, column] : content.datasets)
    if (name == path) return column.length();
  return 0;
}

// Each column of the part is the beginning of the column of the whole, bit by bit, and those of a group end
// at the same row.
void expect_beginning(const Hdf5Content& part, const Hdf5Content& whole) {
  ASSERT_EQ(part.datasets.size(), whole.datasets.size());
  for (std::size_t i = 0; i < part.datasets.size(); ++i) {
    const auto& [path, some] = part.datasets[i];
    const Column& all = whole.datasets[i].second;
    ASSERT_EQ(path, whole.datasets[i].first);
    ASSERT_EQ(some.width, all.width) << path;
    if (path.starts_with("/ticks")) {
      EXPECT_EQ(some.length(), rows_of(part, "/ticks/number")) << path;
    }
    std::visit(
        [&, &of = path](const auto& values) {
          const auto& expected = std::get<std::decay_t<decltype(values)>>(all.values);
          ASSERT_LE(values.size(), expected.size()) << of;
          using Value = std::decay_t<decltype(values[0])>;
          if constexpr (std::is_arithmetic_v<Value>) {
            EXPECT_EQ(std::memcmp(values.data(), expected.data(), values.size() * sizeof(Value)), 0) << of;
          }
        },
        some.values);
  }
  for (const auto& [name, value] : whole.attributes)
    EXPECT_EQ(attribute(part.attributes, name), value) << name;
}

class SessionRecorderOf : public testing::TestWithParam<bool> {
 protected:
  static SensorView view() { return GetParam() ? clouds() : images(); }
};

TEST_P(SessionRecorderOf, MakesTheFileThatTheWriterMakes) {
  const TestFolder folder("session_recorder");
  const Recorded none(0, view());
  none.recorder(folder / "x.h5");
  EXPECT_TRUE(files_in(folder.path()).empty()) << "nothing was recorded";
  for (const int ticks : {0, 1, 99, 100, 101, 1234}) {
    const Recorded recorded(ticks, view());
    const Hdf5Content whole = recorded.whole(folder);
    SessionRecorder recorder = recorded.recorder(folder / "x.h5");
    recorded.fill(recorder, [](std::size_t, std::size_t) {});
    EXPECT_TRUE(fs::exists(folder / "x.h5.unfinished"));
    EXPECT_FALSE(fs::exists(folder / "x.h5"));
    recorder.finish({{"ended", "its duration has elapsed"}});
    EXPECT_EQ(recorder.keep(), "");
    EXPECT_EQ(files_in(folder.path()), (std::vector<std::string>{"whole.h5", "x.h5"}));
    const Hdf5Content made = read_hdf5(folder / "x.h5");
    expect_beginning(made, whole);
    EXPECT_EQ(rows_of(made, "/ticks/number"), recorded.session.ticks.size());
    EXPECT_EQ(rows_of(made, "/frames/number"), recorded.session.frames.size());
    EXPECT_EQ(rows_of(made, "/changes/tick"), recorded.changes.size());
    EXPECT_EQ(attribute(made.attributes, "ended"), "its duration has elapsed");
    fs::remove(folder / "x.h5");
  }
}

// kill -9 at forty moments over the whole recording, its end included: by the process itself between two
// ticks, and from outside at any point of a write. The counts are in memory that outlasts the process.
TEST_P(SessionRecorderOf, AKilledRecordingKeepsEveryBlock) {
  const TestFolder folder("session_recorder");
  const Recorded recorded(2500, view());
  const Hdf5Content whole = recorded.whole(folder);
  struct Counts {
    std::atomic<std::size_t> ticks, frames, finishing;
  };
  void* const shared =
      ::mmap(nullptr, sizeof(Counts), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  std::mt19937_64 random(7);
  int midway = 0, midway_at_least = 0;
  for (int kill = 0; kill < 40; ++kill) {
    Counts& counts = *new (shared) Counts{};
    const std::size_t last = recorded.session.ticks.size(), when = random() % (last + last / 4);
    const bool by_itself = kill % 2 == 0 && when < last;
    midway_at_least += by_itself && when >= SessionRecorder::kTicksInABlock ? 1 : 0;
    const fs::path file = folder / "x.h5", journal = folder / "x.h5.unfinished";
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      SessionRecorder recorder = recorded.recorder(file);
      recorded.fill(recorder, [&](std::size_t ticks, std::size_t frames) {
        counts.frames = frames, counts.ticks = ticks;
        if (by_itself && ticks >= when) ::raise(SIGKILL);
      });
      counts.finishing = 1;
      recorder.finish({{"ended", "its duration has elapsed"}});
      ::_exit(0);
    }
    if (!by_itself) {
      while (counts.ticks < std::min(when, last) || (when > last && counts.finishing == 0)) ::sched_yield();
      if (when > last) ::usleep(static_cast<useconds_t>(random() % 20000));
      ::kill(child, SIGKILL);
    }
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    if (fs::exists(file)) {
      EXPECT_EQ(rows_of(read_hdf5(file), "/ticks/number"), last) << "a file with that name is whole";
      expect_beginning(read_hdf5(file), whole);
    }
    if (fs::exists(journal)) {
      const UnfinishedSession found = read_unfinished(journal);
      EXPECT_GE(found.ticks,
                counts.ticks / SessionRecorder::kTicksInABlock * SessionRecorder::kTicksInABlock);
      EXPECT_GE(found.frames, counts.frames.load());
      EXPECT_FALSE(found.is_growing);
      if (found.ticks + found.frames > 0) {
        recover_session(journal, folder / "r.h5");
        const Hdf5Content part = read_hdf5(folder / "r.h5");
        expect_beginning(part, whole);
        EXPECT_EQ(rows_of(part, "/ticks/number"), found.ticks);
        EXPECT_EQ(rows_of(part, "/frames/number"), found.frames);
        const SessionReader read(folder / "r.h5");  // it can be run
        EXPECT_EQ(read.tick_count(), found.ticks);
        midway += found.ticks < last ? 1 : 0;
      }
    } else {
      EXPECT_TRUE(fs::exists(file) || counts.ticks == 0);
    }
    for (const std::string& name : files_in(folder.path()))
      if (name != "whole.h5") fs::remove(folder / name);
  }
  ::munmap(shared, sizeof(Counts));
  EXPECT_GE(midway, midway_at_least);  // however late the kills from outside come
  EXPECT_GE(midway_at_least, 10);      // the moments are always the same
}

// Every cut of the file: as a full disk or a power cut leaves it.
TEST_P(SessionRecorderOf, AJournalThatIsCutAnywhereGivesItsBeginning) {
  const TestFolder folder("session_recorder");
  const Recorded recorded(230, view());
  const Hdf5Content whole = recorded.whole(folder);
  {
    SessionRecorder recorder = recorded.recorder(folder / "x.h5");
    recorded.fill(recorder, [](std::size_t, std::size_t) {});
  }
  const std::string bytes = bytes_of(folder / "x.h5.unfinished");
  const std::uint64_t all = recorded.session.ticks.size();
  ASSERT_EQ(read_unfinished(folder / "x.h5.unfinished").ticks, all);
  std::uint64_t least = 0;
  for (std::size_t size = 0; size <= bytes.size();
       size += size < bytes.size() && size + 97 > bytes.size() ? 1 : 97) {
    const fs::path cut = folder.write("cut", bytes.substr(0, size));
    try {
      const UnfinishedSession found = recover_session(cut, folder / "r.h5");
      EXPECT_GE(found.ticks, least) << "a longer file has no fewer ticks";
      least = found.ticks;
      EXPECT_EQ(found.has_end, false);
      const Hdf5Content part = read_hdf5(folder / "r.h5");
      expect_beginning(part, whole);
      EXPECT_EQ(attribute(part.attributes, "ended"), kInterruptedRecording);
      EXPECT_HAS(attribute(part.attributes, "notes"),
                 "the recording was interrupted after " + std::to_string(found.ticks) + " ticks");
    } catch (const InputError& error) {
      EXPECT_HAS(std::string(error.what()), cut.string() + ": ");
      EXPECT_EQ(least, 0u) << error.what();
    }
  }
  EXPECT_EQ(least, all);
}

INSTANTIATE_TEST_SUITE_P(Sensors, SessionRecorderOf, testing::Bool(),
                         [](const auto& tested) { return tested.param ? "clouds" : "images"; });

TEST(SessionRecorder, ATickIsNotWholeBeforeTheFrameThatItTook) {
  const TestFolder folder("session_recorder");
  SmallSession session;
  session.add_frame(0, 0);
  SessionRecorder recorder(folder / "x.h5", session.view, session.registered, {{"config", session.config}});
  for (int i = 0; i < 150; ++i) recorder.append(tick(i, i == 120 ? 0 : -1));
  EXPECT_EQ(read_unfinished(folder / "x.h5.unfinished").ticks, 100u);
  recorder.keep();
  EXPECT_EQ(read_unfinished(folder / "x.h5.unfinished").ticks, 120u)
      << "the frame of the next one is missing";
  recorder.append(session.frames[0], 0, 0);
  EXPECT_HAS(recorder.keep(), "x.h5.unfinished keeps 150 ticks and 1 frames");
  EXPECT_EQ(read_unfinished(folder / "x.h5.unfinished").ticks, 150u);
}

TEST(SessionRecorder, DoesNotFinishWithoutAllTicksAndChanges) {
  const TestFolder folder("session_recorder");
  SmallSession session;
  session.add_frame(0, 0);
  SessionRecorder recorder(folder / "x.h5", session.view, session.registered, {{"config", session.config}},
                           kParameters);
  recorder.append(tick(0)), recorder.append(tick(1, 0));
  EXPECT_HAS(refusal([&] { recorder.finish({}); }),
             "x.h5: lacks 1 ticks and 0 changes: expected every frame");
  EXPECT_FALSE(fs::exists(folder / "x.h5"));
  EXPECT_EQ(read_unfinished(folder / "x.h5.unfinished").ticks, 1u);
  recorder.append(session.frames[0], 0, 0);
  recorder.append(SessionChange{2, 0, 0.5});
  EXPECT_HAS(refusal([&] { recorder.finish({}); }), "x.h5: lacks 0 ticks and 1 changes");
  recorder.append(tick(2));
  recorder.finish({});
  EXPECT_EQ(SessionReader(folder / "x.h5").tick_count(), 3u);
}

// The recording ended, but its file could not be written. The whole is recovered, with the attributes of its
// end.
TEST(SessionRecorder, AFileThatCannotBeMadeLeavesTheWhole) {
  const TestFolder folder("session_recorder");
  const Recorded recorded(500, images());
  const Hdf5Content whole = recorded.whole(folder);
  {
    SessionRecorder recorder = recorded.recorder(folder / "x.h5");
    recorded.fill(recorder, [](std::size_t, std::size_t) {});
    fs::create_directory(folder / "x.h5");
    EXPECT_HAS(refusal([&] {
                 recorder.finish({{"ended", "its duration has elapsed"}, {"notes", "n"}});
               }),
               "x.h5: cannot be written");
    EXPECT_HAS(recorder.keep(), "x.h5.unfinished keeps 500 ticks and 16 frames");
  }
  EXPECT_TRUE(read_unfinished(folder / "x.h5.unfinished").has_end);
  recover_session(folder / "x.h5.unfinished", folder / "r.h5");
  const Hdf5Content made = read_hdf5(folder / "r.h5");
  expect_beginning(made, whole);
  EXPECT_EQ(rows_of(made, "/ticks/number"), 500u);
  EXPECT_EQ(attribute(made.attributes, "ended"), "its duration has elapsed");
  EXPECT_EQ(attribute(made.attributes, "notes"), "n");
  EXPECT_TRUE(fs::exists(folder / "x.h5.unfinished")) << "only the user removes it";
}

// An unfinished recording may hold blocks that no recording has: they are left out, or the file is refused.

std::string block_bytes(const TestFolder& folder, const std::vector<JournalBlock>& blocks) {
  fs::remove(folder / "made.unfinished");
  JournalWriter writer(folder / "made", blocks.front());
  for (std::size_t i = 1; i < blocks.size(); ++i) writer.append(blocks[i]);
  return bytes_of(writer.file());
}

JournalBlock block(SessionBlock kind, std::string content) {
  return {static_cast<std::uint32_t>(kind), std::move(content)};
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

// SessionReader refuses some of the changes, so that a recording with them could not be read.
TEST_F(UnfinishedSessionFile, LeavesOutBlocksThatNoRecordingHas) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<JournalBlock> blocks = {start(),
                                      frame(0),
                                      {77, "of another kind"},
                                      ticks({tick(3)}),
                                      ticks({tick(-1)}),
                                      ticks({tick(std::int64_t{1} << 31)}),
                                      ticks({tick(4, 0)}),
                                      ticks({tick(4, 1)}),
                                      ticks({tick(4, -2)}),
                                      ticks({tick(5), tick(4)}),
                                      changes({{5, 0, 0.1}, {4, 0, 0.1}}),
                                      changes({{std::uint64_t{1} << 31, 0, 0.1}}),
                                      changes({{4, 1, 0.1}}),
                                      changes({{4, -1, 0.1}}),
                                      changes({{4, 0, kInfinity}}),
                                      block(SessionBlock::ticks, ""),
                                      block(SessionBlock::ticks, std::string(16, '\xff')),
                                      block(SessionBlock::ticks, ticks({tick(4)}).content + "x"),
                                      block(SessionBlock::frame, ""),
                                      block(SessionBlock::frame, frame(1).content + "x"),
                                      block(SessionBlock::end, "x")};
  StoredFrame stored;
  stored.number = 1;
  blocks.push_back(block(SessionBlock::frame, packed_frame(stored)));
  for (const std::size_t pixels : {0u, 5u, 7u, 1000000u}) {
    stored.depth = deflated_row(std::vector<std::uint16_t>(pixels).data(), pixels, 2);
    blocks.push_back(block(SessionBlock::frame, packed_frame(stored)));
  }
  stored.depth = "no image";
  blocks.push_back(block(SessionBlock::frame, packed_frame(stored)));
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    SCOPED_TRACE(i);
    expect_left_out(blocks[i]);
  }
}

TEST_F(UnfinishedSessionFile, KeepsPossibleChangesAndTheTickInWhichTheDeviceFailed) {
  SessionTick failed = tick(5);
  failed.device.position_W.setConstant(std::nan(""));
  const std::vector<JournalBlock> all{start(), changes({{4, 0, 0.1}, {4, 0, 0.2}}), ticks({failed})};
  const UnfinishedSession found =
      recover_session(folder_.write("x", block_bytes(folder_, all)), folder_ / "r.h5");
  EXPECT_EQ(found.changes, 2u);
  const SessionReader read(folder_ / "r.h5");
  EXPECT_EQ(read.changes().size(), 2u);
  ASSERT_EQ(read.tick_count(), 2u);
  EXPECT_TRUE(std::isnan(read.device(1).position_W.x()));
}

TEST_F(UnfinishedSessionFile, RefusesWhatIsNoSession) {
  SessionLayout narrow = layout_, wide = layout_;
  narrow.width = 0, wide.width = 70000;
  const std::string opening(kJournalOpening), no_start = "x: damaged (its first block is not whole)";
  const auto of = [&](const std::vector<JournalBlock>& blocks) { return block_bytes(folder_, blocks); };
  const std::pair<std::string, std::string> rows[] = {
      {of({start()}), "x: holds no whole tick and no whole frame"},
      {of({frame(0), start()}), no_start},
      {of({block(SessionBlock::start, "")}), no_start},
      {of({block(SessionBlock::start, start().content + "x")}), no_start},
      {of({block(SessionBlock::start, packed_start(narrow, {}))}), no_start},
      {of({block(SessionBlock::start, packed_start(wide, {}))}), no_start},
      {of({block(SessionBlock::start, packed_start(layout_, {{"schema", "remote-touch-session/9"}}))}),
       "is of schema remote-touch-session/9: expected remote-touch-session/3"},
      {"", "x: is not an unfinished recording"},
      {opening, no_start},
      {opening + std::string(1000, '\x5a'), no_start}};
  for (const auto& row : rows) {
    const fs::path file = folder_.write("x", row.first);
    EXPECT_HAS(refusal([&] { recover_session(file, folder_ / "r.h5"); }), row.second);
    EXPECT_FALSE(fs::exists(folder_ / "r.h5")) << row.second;
  }
}

TEST_F(UnfinishedSessionFile, IsNeitherRecoveredWhileItIsRecordedNorReadAsASession) {
  {
    SessionRecorder recorder(folder_ / "x.h5", session_.view, session_.registered,
                             {{"config", session_.config}});
    for (int i = 0; i < 100; ++i) recorder.append(tick(i));
    EXPECT_TRUE(read_unfinished(folder_ / "x.h5.unfinished").is_growing);
    EXPECT_HAS(refusal([&] { recover_session(folder_ / "x.h5.unfinished", folder_ / "r.h5"); }),
               "x.h5.unfinished: is being recorded");
  }
  EXPECT_HAS(refusal([&] { SessionReader(folder_ / "x.h5.unfinished"); }), "is an unfinished recording");
  EXPECT_HAS(refusal([&] { SessionReader(folder_ / "x.h5"); }), "its unfinished recording is there");
}

}  // namespace
}  // namespace remote_touch::session_recorder_test
