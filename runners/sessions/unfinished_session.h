// The journal of a session that was not finished: what it holds, and a session file that is made of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "runners/sessions/session_file.h"

namespace remote_touch {

// Everything up to the last whole block. A tick that took a frame is whole only with that frame.
struct UnfinishedSession {
  TextAttributes attributes;  // of the session, without those known at its end only
  std::uint64_t ticks = 0, frames = 0, changes = 0;
  std::int64_t last_tick = -1;       // its number; -1: there are none
  bool is_whole = false;             // the recording ended, and only the session file was not made
  TextAttributes ending;             // of that end: `ended`, why, and others
  std::uint64_t left_out_bytes = 0;  // behind the last whole block
  bool is_growing = false;           // its program is recording
};

// Throws InputError when the file is missing, or is no journal of a session with a whole first block. Images
// are not decompressed.
UnfinishedSession read_unfinished(const std::filesystem::path& journal);

// Makes a session file of the journal, which stays as it is. If the recording was interrupted, `ended` is
// kInterruptedRecording, and `notes` says how much there is. A block whose images cannot be decompressed is
// not whole. Throws InputError as read_unfinished(), and when the journal holds neither ticks nor frames, its
// program is still recording, or the target cannot be written.
UnfinishedSession recover_session(const std::filesystem::path& journal, const std::filesystem::path& target);

// The same for the program that recorded it: the compressed images are not checked again.
void make_session(const std::filesystem::path& journal, const std::filesystem::path& target);

// Contents of the blocks of the journal.
enum class SessionBlock : std::uint32_t { start, ticks, frame, end };
std::string packed_start(const SessionLayout& layout, const TextAttributes& attributes);
// The changes belong to these ticks, or to ticks that were missed between them.
std::string packed_ticks(std::span<const SessionTick> ticks, std::span<const SessionChange> changes);
std::string packed_frame(const StoredFrame& frame);
std::string packed_end(const TextAttributes& attributes);

}  // namespace remote_touch
