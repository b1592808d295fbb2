#include "runners/experiment/sessions/session_recorder.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "core/parameters/input_error.h"
#include "runners/experiment/sessions/unfinished_session.h"

namespace remote_touch {

namespace {

JournalBlock block(SessionBlock kind, std::string content) {
  return {static_cast<std::uint32_t>(kind), std::move(content)};
}

}  // namespace

SessionRecorder::SessionRecorder(const std::filesystem::path& target, const SensorView& view,
                                 const RigidTransform& registered, const TextAttributes& provenance,
                                 const std::vector<std::string>& live_parameters)
    : target_(target),
      layout_(layout_of(view)),
      journal_(
          target,
          block(SessionBlock::start,
                packed_start(layout_, session_attributes(view, registered, provenance, live_parameters)))) {}

SessionRecorder::~SessionRecorder() {
  if (finished_) return;
  keep();
  if (ticks_written_ == 0 && frames_written_ == 0) journal_.remove();
}

void SessionRecorder::append(const SessionTick& tick) {
  ticks_.push_back(tick);
  flush(kTicksInABlock);
}

void SessionRecorder::append(const SensorFrame& frame, double captured_s, std::uint64_t fixtures_off) {
  journal_.append(
      block(SessionBlock::frame, packed_frame(stored_frame(layout_, frame, captured_s, fixtures_off))));
  ++frames_written_;
}

// Returns the number of ticks before the first one whose frame is not yet in the journal. A journal is read
// up to the first block that is not whole, so such a tick might lack its frame.
std::size_t SessionRecorder::ready_ticks() const {
  const auto written = static_cast<std::int64_t>(frames_written_);
  const auto waits = [&](const SessionTick& tick) { return tick.taken >= written; };
  return static_cast<std::size_t>(std::find_if(ticks_.begin(), ticks_.end(), waits) - ticks_.begin());
}

void SessionRecorder::flush(std::size_t at_least) {
  if (ticks_.size() < at_least) return;
  const std::size_t count = ready_ticks();
  if (count < at_least || count == 0) return;
  const auto last = static_cast<std::uint64_t>(ticks_[count - 1].number);
  const auto is_later = [&](const SessionChange& change) { return change.tick > last; };
  const auto change_count =
      static_cast<std::size_t>(std::find_if(changes_.begin(), changes_.end(), is_later) - changes_.begin());
  journal_.append(
      block(SessionBlock::ticks, packed_ticks({ticks_.data(), count}, {changes_.data(), change_count})));
  ticks_written_ += count;
  ticks_.erase(ticks_.begin(), ticks_.begin() + static_cast<std::ptrdiff_t>(count));
  changes_.erase(changes_.begin(), changes_.begin() + static_cast<std::ptrdiff_t>(change_count));
}

// Throws InputError if ticks or changes are in memory that cannot be written. A recording without them would
// count as complete.
void SessionRecorder::require_nothing_left() const {
  if (ticks_.empty() && changes_.empty()) return;
  throw InputError(target_.string(), "lacks " + std::to_string(ticks_.size()) + " ticks and " +
                                         std::to_string(changes_.size()) +
                                         " changes: expected every frame that a tick took, and a tick after "
                                         "every change");
}

void SessionRecorder::finish(const TextAttributes& attributes) {
  flush(1);
  require_nothing_left();
  journal_.append(block(SessionBlock::end, packed_end(attributes)));
  journal_.sync();
  make_session(journal_.file(), target_);
  journal_.remove();
  finished_ = true;
}

std::string SessionRecorder::keep() noexcept try {
  if (finished_) return {};
  try {
    flush(1);
  } catch (const std::exception&) {
    // There is no room: these ticks are lost, the blocks before are not.
  }
  if (ticks_written_ == 0 && frames_written_ == 0) return {};
  const std::string file = journal_.file().string();
  return file + " keeps " + std::to_string(ticks_written_) + " ticks and " + std::to_string(frames_written_) +
         " frames; `remote-touch recover " + file + " -o FILE` makes a recording of them";
} catch (const std::exception&) {
  return {};
}

}  // namespace remote_touch
