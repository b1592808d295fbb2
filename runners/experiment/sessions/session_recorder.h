// Records a live session so that no failure of the program loses it. While the session runs, the recording is
// a journal beside its file (analysis/storage/block_journal.h). At the end a session file is made of the
// journal. If there is no end, because the program is killed or the disk is full, the journal stays.
#pragma once

#include <cstdint>
#include <filesystem>
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
  // pre: is_complete(frame, view).
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

}  // namespace remote_touch
