// Recorded sessions, finished or not.
#include <unistd.h>
#include <zlib.h>
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "analysis/storage/block_journal.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/sessions/session_file.h"
#include "runners/experiment/sessions/session_scene.h"
#include "tests/fuzz/shared/content_text.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::sessions {
namespace {

// Recorded sessions (content_text.h): view, ticks and frames.

void read_session(std::string_view bytes) {
  accepts(bytes, [&] {
    const SessionReader session(reader_of(content_of(bytes)));
    const CameraIntrinsics& camera = session.view().camera;
    require(camera.width > 0 && camera.height > 0 && session.haptic_rate_hz() > 0, "a session has a view");
    for (std::size_t i = 0; i < session.tick_count(); ++i) {
      require(session.taken(i) < static_cast<std::int32_t>(session.frame_count()), "a frame was recorded");
      session.device(i);
    }
    for (std::size_t i = 0; i < session.frame_count(); ++i)
      require(session.frame(i).depth.size() == camera.pixels(), "every pixel has a depth");
    Experiment::from_json(session_experiment(session, "fuzz.h5"), "fuzz.h5");
  });
}

const Registered of_session("session_file", read_session);

// Unfinished recordings: the bytes as they are, and with corrected numbers and checksums of the blocks.

// Positions in the header of a block, see block_journal.h.
constexpr std::size_t kNumber = 8, kSize = 16, kContentSum = 24, kHeaderSum = 28, kHeaderSize = 32;

template <class Value>
void put(std::string& bytes, std::size_t at, Value value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

std::uint32_t sum(const std::string& bytes, std::size_t at, std::size_t size) {
  return static_cast<std::uint32_t>(::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data() + at), size));
}

std::string mended(std::string bytes) {
  std::uint64_t number = 0;
  for (std::size_t at = kJournalOpening.size(); at + kHeaderSize <= bytes.size();) {
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data() + at + kSize, sizeof size);
    size = std::min<std::uint64_t>(size, bytes.size() - at - kHeaderSize);
    std::memcpy(bytes.data() + at, "RTb1", 4);
    put(bytes, at + kNumber, number++), put(bytes, at + kSize, size);
    put(bytes, at + kContentSum, sum(bytes, at + kHeaderSize, size));
    put(bytes, at + kHeaderSum, sum(bytes, at, kHeaderSum));
    at += kHeaderSize + size;
  }
  return bytes;
}

void recover(const std::string& bytes) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("fuzz-unfinished-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "x.unfinished", std::ios::binary) << bytes;
  accepts(bytes, [&] {
    const UnfinishedSession found = recover_session(folder / "x.unfinished", folder / "x.h5");
    const SessionReader session(folder / "x.h5");
    require(session.tick_count() == found.ticks, "every tick is recovered");
    require(session.frame_count() == found.frames, "every frame is recovered");
    for (std::size_t i = 0; i < session.frame_count(); ++i) session.frame(i);
  });
  std::filesystem::remove_all(folder);
}

void read_unfinished(std::string_view bytes) {
  recover(std::string(bytes));
  recover(mended(std::string(bytes)));
}

const Registered of_unfinished("unfinished_session", read_unfinished);

}  // namespace
}  // namespace remote_touch::fuzz::sessions
