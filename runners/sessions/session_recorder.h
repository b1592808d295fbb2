// Records a live session so that nothing loses it: the recording grows in a journal beside its file
// (analysis/storage/block_journal.h), and becomes a session file at the end. If there is no end (the program
// is killed, the disk is full), the journal stays.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/storage/block_journal.h"
#include "runners/sessions/session_file.h"

namespace remote_touch {

// Members throw InputError naming the target when it cannot be written. Not for use from several threads at
// once, except sync().
class SessionRecorder {
 public:
  // Fewer ticks than these are in memory only, unless they took a frame that is not written yet.
  static constexpr std::size_t kTicksInABlock = 100;

  // Throws InputError if the journal of the target exists already.
  SessionRecorder(const std::filesystem::path& target, const SensorView& view,
                  const RigidTransform& registered, const TextAttributes& provenance,
                  const std::vector<std::string>& live_parameters = {});
  // Keeps the journal if finish() was not called and anything was recorded.
  ~SessionRecorder();
  SessionRecorder(const SessionRecorder&) = delete;
  SessionRecorder& operator=(const SessionRecorder&) = delete;

  // A change comes before the tick that has its number.
  void append(const SessionTick& tick);
  void append(const SessionChange& change) { changes_.push_back(change); }
  // pre: is_complete(frame, view).
  void append(const SensorFrame& frame, double captured_s, std::uint64_t fixtures_off);
  // Makes what was written until now outlast a power cut. Another thread may call it.
  void sync() const { journal_.sync(); }
  // Makes the session file, with these attributes also, and then removes the journal. When it throws, the
  // journal stays, and is whole. attributes: `ended`, why the run ended, and others known at the end only.
  void finish(const TextAttributes& attributes);

  // Writes the ticks in memory, if there is room. Returns "FILE keeps N ticks and M frames; ..."; empty if
  // finish() was done or nothing is kept.
  std::string keep() noexcept;

 private:
  void flush(std::size_t at_least);
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
