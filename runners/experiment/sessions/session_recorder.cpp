#include "runners/experiment/sessions/session_file.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/other_processes.h"
#include "core/parameters/parameter.h"

namespace remote_touch {
namespace {

JournalBlock block(SessionBlock kind, std::string content) {
  return {static_cast<std::uint32_t>(kind), std::move(content)};
}

constexpr std::uint32_t kMaxImageSide_px = 65535;
constexpr std::int64_t kMaxTickNumber = std::numeric_limits<std::int32_t>::max();

// These functions pack or unpack every field, in the same order.
template <class Direction, class Vector>
void visit_vector(Direction& pack, Vector& v) {
  for (int i = 0; i < 3; ++i) pack.value(v[i]);
}

template <class Direction, class Tick>
void visit_tick(Direction& pack, Tick& tick) {
  pack.value(tick.number);
  visit_vector(pack, tick.device.position_W);
  auto& q = tick.device.orientation_W;
  pack.value(q.w()), pack.value(q.x()), pack.value(q.y()), pack.value(q.z());
  pack.value(tick.device.buttons), pack.value(tick.taken);
  visit_vector(pack, tick.written.force_N), visit_vector(pack, tick.written.torque_Nm);
  pack.value(tick.gate);
}

template <class Direction, class Change>
void visit_change(Direction& pack, Change& change) {
  pack.value(change.tick), pack.value(change.parameter), pack.value(change.value);
}

template <class Direction, class Frame>
void visit_frame(Direction& pack, Frame& frame) {
  pack.value(frame.number), pack.value(frame.captured_s), pack.value(frame.fixtures_off);
  pack.value(frame.point_count);
  pack.text(frame.depth), pack.text(frame.colour);
}

// Packs names and values alternately.
void pack(Packer& packer, const TextAttributes& attributes) {
  std::vector<std::string> texts;
  for (const auto& [name, value] : attributes) texts.push_back(name), texts.push_back(value);
  packer.list(texts);
}

bool unpack(Unpacker& unpacker, TextAttributes& attributes) {
  std::vector<std::string> texts;
  unpacker.list(texts);
  for (std::size_t i = 0; i + 1 < texts.size(); i += 2) attributes.emplace_back(texts[i], texts[i + 1]);
  return unpacker.good() && texts.size() % 2 == 0;
}

bool unpack_start(const JournalBlock& block, SessionLayout& layout, TextAttributes& attributes) {
  Unpacker unpacker(block.content);
  std::uint8_t has_colour = 0;
  unpacker.value(layout.width), unpacker.value(layout.height), unpacker.value(layout.numbers_per_point);
  unpacker.value(has_colour);
  layout.has_colour = has_colour != 0;
  const bool has_attributes = unpack(unpacker, attributes) && unpacker.done();
  const bool has_images = layout.width >= 1 && layout.width <= kMaxImageSide_px && layout.height >= 1 &&
                          layout.height <= kMaxImageSide_px && layout.numbers_per_point == 0;
  const bool has_clouds = layout.width == 0 && layout.height == 0 &&
                          (layout.numbers_per_point == 3 || layout.numbers_per_point == 6);
  return block.kind == static_cast<std::uint32_t>(SessionBlock::start) && has_attributes && has_colour <= 1 &&
         (has_images || has_clouds);
}

struct TickBlock {
  std::vector<SessionTick> ticks;
  std::vector<SessionChange> changes;
};

std::optional<TickBlock> unpacked_ticks(const std::string& content) {
  Unpacker unpacker(content);
  TickBlock block;
  std::uint64_t tick_count = 0, change_count = 0;
  unpacker.value(tick_count), unpacker.value(change_count);
  for (std::uint64_t i = 0; i < tick_count && unpacker.good(); ++i)
    visit_tick(unpacker, block.ticks.emplace_back());
  for (std::uint64_t i = 0; i < change_count && unpacker.good(); ++i)
    visit_change(unpacker, block.changes.emplace_back());
  if (!unpacker.done()) return {};
  return block;
}

std::optional<StoredFrame> unpacked_frame(const std::string& content) {
  Unpacker unpacker(content);
  StoredFrame frame;
  visit_frame(unpacker, frame);
  if (!unpacker.done()) return {};
  return frame;
}

bool has_size(const StoredFrame& frame, const SessionLayout& layout) {
  const std::size_t points = frame.point_count;
  if (layout.has_clouds())
    return frame.depth.size() == points * layout.numbers_per_point * sizeof(float) &&
           frame.colour.size() == (layout.has_colour ? points * sizeof(std::uint32_t) : 0);
  return points == 0 && !frame.depth.empty() && frame.colour.empty() != layout.has_colour;
}

// Checks that the bytes of images can be decompressed, because the HDF5 library later does not check them.
bool holds_images(const StoredFrame& frame, const SessionLayout& layout) {
  if (layout.has_clouds()) return true;
  return is_deflated_row(frame.depth, layout.pixels() * sizeof(std::uint16_t)) &&
         (!layout.has_colour || is_deflated_row(frame.colour, layout.pixels() * sizeof(std::uint32_t)));
}

// Returns the number of live parameters; 0 if their list cannot be read.
std::size_t parameter_count(const TextAttributes& attributes) {
  const auto names = nlohmann::json::parse(attribute(attributes, "live_parameters"), nullptr, false);
  return names.is_array() ? names.size() : 0;
}

// Reads a journal of a session from its first block to its last whole one.
class SessionBlocks {
 public:
  explicit SessionBlocks(const std::filesystem::path& journal) : reader_(journal) {
    const std::optional<JournalBlock> first = reader_.next();
    if (!first || !unpack_start(*first, layout_, found_.attributes))
      throw InputError(journal.string(),
                       "damaged (its first block is not whole): expected an unfinished recording");
    if (const std::string schema = attribute(found_.attributes, "schema"); schema != schema_name("session"))
      throw InputError(journal.string(), "is of schema " + schema + ": expected " + schema_name("session"));
    parameters_ = parameter_count(found_.attributes);
    found_.is_growing = reader_.is_growing();
  }

  const SessionLayout& layout() const { return layout_; }
  const TextAttributes& attributes() const { return found_.attributes; }

  // writer: receives all ticks, changes and frames; may be null. checks_images: a frame whose images cannot
  // be read counts as not whole.
  UnfinishedSession read_all(SessionWriter* writer, bool checks_images) {
    while (const std::optional<JournalBlock> block = reader_.next()) {
      if (take(*block, writer, checks_images)) continue;
      reader_.reject();
      break;
    }
    found_.left_out_bytes = reader_.left();
    return found_;
  }

 private:
  // Returns false if the content does not fit its kind, or contradicts the blocks before.
  bool take(const JournalBlock& block, SessionWriter* writer, bool checks_images) {
    if (found_.has_end) return false;
    switch (static_cast<SessionBlock>(block.kind)) {
      case SessionBlock::ticks:
        return take_ticks(block.content, writer);
      case SessionBlock::frame:
        return take_frame(block.content, writer, checks_images);
      case SessionBlock::end:
        return take_end(block.content);
      case SessionBlock::start:
        break;
    }
    return false;
  }

  bool take_ticks(const std::string& content, SessionWriter* writer) {
    const std::optional<TickBlock> block = unpacked_ticks(content);
    if (!block || !are_possible(block->ticks) || !are_possible(block->changes)) return false;
    for (const SessionTick& tick : block->ticks) {
      if (writer) writer->append(tick);
      found_.last_tick = tick.number;
      if (tick.taken >= 0) last_taken_ = tick.taken;
    }
    for (const SessionChange& change : block->changes) {
      if (writer) writer->append(change);
      last_change_ = change.tick;
    }
    found_.ticks += block->ticks.size(), found_.changes += block->changes.size();
    return true;
  }

  // True if the tick numbers increase, and if each tick that received a frame names an earlier frame of the
  // journal, newer than the one before. SessionReader requires the same. The state of a device that failed
  // is NaN.
  bool are_possible(const std::vector<SessionTick>& ticks) const {
    std::int64_t number = found_.last_tick, taken = last_taken_;
    for (const SessionTick& tick : ticks) {
      if (tick.number <= number || tick.number > kMaxTickNumber) return false;
      number = tick.number;
      if (tick.taken == -1) continue;
      if (tick.taken <= taken || tick.taken >= static_cast<std::int64_t>(found_.frames)) return false;
      taken = tick.taken;
    }
    return true;
  }

  // True if the ticks of the changes do not decrease, and if each change has a finite value of a parameter of
  // the list. SessionReader requires the same.
  bool are_possible(const std::vector<SessionChange>& changes) const {
    std::uint64_t last = last_change_;
    for (const SessionChange& change : changes) {
      if (change.tick < last || change.tick > static_cast<std::uint64_t>(kMaxTickNumber)) return false;
      if (change.parameter < 0 || static_cast<std::size_t>(change.parameter) >= parameters_) return false;
      if (!std::isfinite(change.value)) return false;
      last = change.tick;
    }
    return true;
  }

  bool take_frame(const std::string& content, SessionWriter* writer, bool checks_images) {
    const std::optional<StoredFrame> frame = unpacked_frame(content);
    if (!frame || !has_size(*frame, layout_)) return false;
    if (frame->number <= last_frame_number_ || !(frame->captured_s > last_captured_s_) ||
        !std::isfinite(frame->captured_s))
      return false;
    if (checks_images && !holds_images(*frame, layout_)) return false;
    if (writer) writer->append(*frame);
    last_frame_number_ = frame->number, last_captured_s_ = frame->captured_s;
    ++found_.frames;
    return true;
  }

  bool take_end(const std::string& content) {
    Unpacker unpacker(content);
    found_.has_end = unpack(unpacker, found_.ending) && unpacker.done();
    return found_.has_end;
  }

  JournalReader reader_;
  SessionLayout layout_;
  UnfinishedSession found_;
  std::size_t parameters_ = 0;  // number of live parameters
  std::int64_t last_taken_ = -1;
  std::uint64_t last_change_ = 0;
  std::int64_t last_frame_number_ = std::numeric_limits<std::int64_t>::min();
  double last_captured_s_ = -std::numeric_limits<double>::infinity();
};

// Returns the attributes of the file that are known only at the end.
TextAttributes ending_of(const UnfinishedSession& session) {
  if (session.has_end) return session.ending;
  return {{"ended", kInterruptedRecording},
          {"notes", "the recording was interrupted after " + std::to_string(session.ticks) + " ticks and " +
                        std::to_string(session.frames) + " frames"}};
}

UnfinishedSession make(const std::filesystem::path& journal, const std::filesystem::path& target,
                       bool is_ours) {
  if (!is_ours) {
    const UnfinishedSession found = read_unfinished(journal);
    if (found.is_growing)
      throw InputError(journal.string(), "is being recorded: expected a recording whose program has ended");
    if (found.ticks == 0 && found.frames == 0)
      throw InputError(journal.string(),
                       "holds no whole tick and no whole frame: expected a recording with some");
  }
  SessionBlocks blocks(journal);
  SessionWriter writer(target, blocks.layout(), blocks.attributes());
  const UnfinishedSession made = blocks.read_all(&writer, !is_ours);
  if (is_ours && !made.has_end)  // the disk has lost something
    throw InputError(journal.string(),
                     "damaged (a block is not as it was written): expected a disk that works");
  writer.finish(ending_of(made));
  return made;
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

UnfinishedSession read_unfinished(const std::filesystem::path& journal) {
  return SessionBlocks(journal).read_all(nullptr, false);
}

UnfinishedSession recover_session(const std::filesystem::path& journal, const std::filesystem::path& target) {
  return make(journal, target, false);
}

void make_session(const std::filesystem::path& journal, const std::filesystem::path& target) {
  make(journal, target, true);
}

std::string packed_start(const SessionLayout& layout, const TextAttributes& attributes) {
  MemoryPacker packer;
  packer.value(layout.width), packer.value(layout.height), packer.value(layout.numbers_per_point);
  packer.value(static_cast<std::uint8_t>(layout.has_colour));
  pack(packer, attributes);
  return packer.take();
}

std::string packed_ticks(std::span<const SessionTick> ticks, std::span<const SessionChange> changes) {
  MemoryPacker packer;
  packer.value(static_cast<std::uint64_t>(ticks.size()));
  packer.value(static_cast<std::uint64_t>(changes.size()));
  for (const SessionTick& tick : ticks) visit_tick(packer, tick);
  for (const SessionChange& change : changes) visit_change(packer, change);
  return packer.take();
}

std::string packed_frame(const StoredFrame& frame) {
  MemoryPacker packer;
  visit_frame(packer, frame);
  return packer.take();
}

std::string packed_end(const TextAttributes& attributes) {
  MemoryPacker packer;
  pack(packer, attributes);
  return packer.take();
}

}  // namespace remote_touch
