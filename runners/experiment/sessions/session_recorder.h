// Records a live session so that no failure of the program loses it. While the session runs, the recording is
// a journal beside its file (analysis/storage/block_journal.h). At the end a session file is made of the
// journal. If there is no end, because the program is killed or the disk is full, the journal stays.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "analysis/storage/block_journal.h"
#include "runners/experiment/sessions/session_file.h"

namespace remote_touch {

// Members throw InputError, which names the target, if it cannot be written. Only one thread may use an
// object at a time, except for sync().
class SessionRecorder {
 public:
  // Ticks are written in blocks of at least this many, and are only in memory until then. More ticks wait if
  // they took a frame that is not written yet.
  static constexpr std::size_t kTicksInABlock = 100;

  // Throws InputError if the journal of the target exists already.
  SessionRecorder(const std::filesystem::path& target, const SensorView& view,
                  const RigidTransform& registered, const TextAttributes& provenance,
                  const std::vector<std::string>& live_parameters = {});
  // If finish() has not succeeded, keeps the journal if a tick or a frame was recorded, and removes it
  // otherwise.
  ~SessionRecorder();
  SessionRecorder(const SessionRecorder&) = delete;
  SessionRecorder& operator=(const SessionRecorder&) = delete;

  // A change must be appended before the tick that has its number.
  void append(const SessionTick& tick);
  void append(const SessionChange& change) { changes_.push_back(change); }
  void append(const SensorFrame& frame, double captured_s, std::uint64_t fixtures_off);
  // Makes everything that was written until now survive a power cut. Another thread may call it.
  void sync() const { journal_.sync(); }
  // Makes the session file, with these attributes added, and then removes the journal. If it throws, the
  // journal stays, with every block that was written. Throws InputError also if a tick took a frame that was
  // not appended, or a change has no tick. attributes: `ended`, why the run ended, and others that
  // are known only at the end.
  void finish(const TextAttributes& attributes);

  // Writes the ticks in memory, if there is room. Returns "FILE keeps N ticks and M frames; ..."; empty if
  // finish() has succeeded or nothing is kept.
  std::string keep() noexcept;

 private:
  void flush(std::size_t at_least);
  void require_nothing_left() const;
  std::size_t ready_ticks() const;

  const std::filesystem::path target_;
  const SessionLayout layout_;
  JournalWriter journal_;
  std::vector<SessionTick> ticks_;
  std::vector<SessionChange> changes_;
  std::uint64_t ticks_written_ = 0, frames_written_ = 0;
  bool finished_ = false;
};

// The content of the journal of a session that was not finished, up to the last whole block. A block of ticks
// is whole only if the frames that these ticks took come before it.
struct UnfinishedSession {
  TextAttributes attributes;  // attributes of the session, without those known only at its end
  std::uint64_t ticks = 0, frames = 0, changes = 0;
  std::int64_t last_tick = -1;       // its number; -1: there are none
  bool has_end = false;              // the last block is there: only the session file was not made
  TextAttributes ending;             // attributes known at that end: `ended`, the reason, and others
  std::uint64_t left_out_bytes = 0;  // number of bytes after the last whole block
  bool is_growing = false;           // its program was recording when the journal was opened
};

// Throws InputError if the file is missing, or if it is no journal of a session with a whole first block.
// Does not decompress images.
UnfinishedSession read_unfinished(const std::filesystem::path& journal);

// Makes a session file of the journal, which stays unchanged. If the recording was interrupted, `ended` is
// kInterruptedRecording, and `notes` states the number of ticks and frames. A block whose images cannot be
// decompressed counts as not whole. Throws InputError as read_unfinished() does. It also throws InputError if
// the journal holds neither ticks nor frames, if its program is still recording, or if the target cannot be
// written.
UnfinishedSession recover_session(const std::filesystem::path& journal, const std::filesystem::path& target);

// The same for the program that recorded the journal, after it has written the last block. The compressed
// images are not checked again. Throws InputError also if a block is not as it was written.
void make_session(const std::filesystem::path& journal, const std::filesystem::path& target);

// The kinds of blocks in the journal, and functions that pack their contents.
enum class SessionBlock : std::uint32_t { start, ticks, frame, end };
std::string packed_start(const SessionLayout& layout, const TextAttributes& attributes);
// changes: those of these ticks, and of ticks that were missed between them.
std::string packed_ticks(std::span<const SessionTick> ticks, std::span<const SessionChange> changes);
std::string packed_frame(const StoredFrame& frame);
std::string packed_end(const TextAttributes& attributes);

}  // namespace remote_touch
