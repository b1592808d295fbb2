// The journal of a session that was not finished: reads its content, and makes a session file of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "runners/experiment/sessions/session_file.h"

namespace remote_touch {

// The content up to the last whole block. A block of ticks is whole only if the frames that these ticks took
// come before it.
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
