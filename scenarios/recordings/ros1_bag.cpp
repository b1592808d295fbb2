// Bags of ROS 1 (.bag, version 2.0), as rosbag and librealsense write them.
#include <bzlib.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <mutex>
#include <new>

#include "core/parameters/parameter.h"
#include "scenarios/files/input_files.h"
#include "scenarios/recordings/bag_file.h"

namespace remote_touch {

namespace {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr std::uint64_t kLength = 4;
constexpr std::uint64_t kMaxValues = 1u << 20;       // bytes of a record's named values
constexpr std::uint64_t kMaxConnection = 16u << 20;  // the definition of a message can be long

std::uint32_t number_in(std::string_view bytes) {
  std::uint32_t number = 0;
  std::memcpy(&number, bytes.data(), sizeof number);
  return number;
}

using Values = std::map<std::string, std::string>;

// Returns the value of that name; empty if there is none.
std::string text_in(const Values& values, const std::string& name) {
  const auto found = values.find(name);
  return found == values.end() ? "" : found->second;
}

// Decodes the fields name=value, each with its length in front.
Values named_values(std::string_view bytes, const std::string& subject) {
  Values values;
  MessageCursor cursor(bytes, WireFormat::ros1, subject);
  while (cursor.left() > 0) {
    const std::string value = cursor.text();
    const std::size_t at = value.find('=');
    if (at == std::string::npos) refuse(subject, "has a record with a value that has no name");
    values[value.substr(0, at)] = value.substr(at + 1);
  }
  return values;
}

void check_values(std::uint64_t size, const std::string& subject) {
  if (size > kMaxValues)
    refuse(subject, "has a record with ", size, " bytes of values: expected up to ", kMaxValues);
}

// A record: named values, then data.
struct Ros1Record {
  enum Opcode { message = 2, bag_header = 3, index = 4, chunk = 5, chunk_info = 6, connection = 7 };

  Values values;
  std::uint64_t data_at = 0, data_size = 0;  // position and size in the file, or in the records of a chunk
  std::uint64_t end() const { return data_at + data_size; }
  // Both throw InputError about the subject if there is no such value.
  std::uint32_t number(const std::string& name, const std::string& subject) const {
    const auto found = values.find(name);
    if (found == values.end() || found->second.size() != sizeof(std::uint32_t))
      refuse(subject, "has a record without the number '", name, "'");
    return number_in(found->second);
  }

  int opcode(const std::string& subject) const {
    const auto found = values.find("op");
    if (found == values.end() || found->second.size() != 1)
      refuse(subject, "has a record without a valid opcode");
    return static_cast<unsigned char>(found->second[0]);
  }
};

// bytes(from, size) returns bytes of a file or of a decoded chunk.
template <class Bytes>
Ros1Record record_of(Bytes&& bytes, std::uint64_t at, const std::string& subject) {
  Ros1Record record;
  const std::uint64_t values = number_in(bytes(at, kLength));
  check_values(values, subject);
  record.values = named_values(bytes(at + kLength, values), subject);
  record.data_size = number_in(bytes(at + kLength + values, kLength));
  record.data_at = at + 2 * kLength + values;
  return record;
}

// Reads a time: two numbers of 32 bits, seconds and nanoseconds.
std::int64_t time_ns(MessageCursor& cursor) {
  const std::int64_t seconds = cursor.u32();
  return seconds * 1'000'000'000 + cursor.u32();
}

// Finds messages by the lists behind the chunks. If the bag was not closed or was cut short, it reads all
// whole chunks instead. A recorder that was killed leaves an open chunk at the end, whose record claims 0
// bytes: the whole messages behind that record are read, too.
class Ros1Bag final : public BagFile {
 public:
  Ros1Bag(const std::filesystem::path& file, const WantedTopic& wanted)
      : BagFile(file.string(), wanted), file_(file) {
    const std::string_view any_version = kMagic.substr(0, 9);
    const bool long_enough = file_.has(0, kMagic.size());
    const std::string start = long_enough ? file_.bytes(0, kMagic.size()) : "";
    if (start != kMagic)
      refuse(name_, start.starts_with(any_version) ? "is a bag of an older version: expected 2.0"
                                                   : "does not begin as a bag of ROS 1");
    const bool is_whole = walk();
    if (is_whole && is_closed_) {
      for (const Listed& entry : listed_)
        if (entry.index_at > 0) add_index(entry.chunk_at, record_at(entry.index_at));
    } else {
      std::size_t messages = 0;
      for (const Listed& entry : listed_)
        if (entry.index_at == 0) scan_chunk(entry.chunk_at, messages);
      remark_ = is_whole ? "was not closed: it was read from end to end"
                         : "was cut short: only its whole chunks are used";
      if (open_at_ > 0) scan_open_chunk();
    }
    sort_places();
  }

  std::string start(const MessagePlace& place, std::uint64_t max_bytes) const override {
    const std::lock_guard lock(mutex_);
    if (!chunk_ || chunk_->record_at() != place.part) {
      chunk_.reset();  // frees memory before the next one takes some
      chunk_ = open_chunk(place.part);
    }
    const Ros1Record record = record_in(*chunk_, place.at);
    if (record.opcode(name_) != Ros1Record::message)
      refuse(name_, "the chunk at byte ", place.part, " has no message at its byte ", place.at);
    require_length(record.data_size);
    return std::string(chunk_->view(record.data_at, std::min(record.data_size, max_bytes)));
  }

 private:
  Ros1Record record_at(std::uint64_t at) const {
    return record_of([this](std::uint64_t from, std::uint64_t size) { return file_.bytes(from, size); }, at,
                     name_);
  }

  Ros1Record record_in(BagChunk& chunk, std::uint64_t at) const {
    return record_of([&chunk](std::uint64_t from, std::uint64_t size) { return chunk.view(from, size); }, at,
                     name_);
  }

  std::unique_ptr<BagChunk> open_chunk(std::uint64_t at) const {
    const Ros1Record record = record_at(at);
    ChunkPlace place;
    place.record_at = at, place.stored_at = record.data_at, place.stored_size = record.data_size;
    place.size = record.number("size", name_);
    place.compression = text_in(record.values, "compression");
    place.is_open = at == open_at_;
    if (place.is_open) place.stored_size = file_.size() - place.stored_at;
    return std::make_unique<BagChunk>(file_, place);
  }

  // Reads the records of the file itself, not those inside chunks. Returns false if the file ends within a
  // record, or with an open chunk.
  bool walk() {
    constexpr std::size_t kMaxListed = 1u << 24;
    std::uint64_t chunk_at = 0;
    for (std::uint64_t at = kMagic.size(); at < file_.size();) {
      if (!file_.has(at, kLength)) return false;
      const std::uint64_t values = number_in(file_.bytes(at, kLength));
      check_values(values, name_);
      if (!file_.has(at, values + 2 * kLength)) return false;
      const Ros1Record record = record_at(at);
      if (!file_.has(record.data_at, record.data_size)) return false;
      const int opcode = record.opcode(name_);
      if (opcode == Ros1Record::bag_header) {
        const auto index_pos = record.values.find("index_pos");
        is_closed_ = index_pos != record.values.end() && index_pos->second != std::string(8, '\0');
        if (!text_in(record.values, "encryptor").empty()) refuse(name_, "is encrypted: expected a plain bag");
      }
      if (opcode == Ros1Record::chunk && record.data_size == 0 && !is_closed_) {
        open_at_ = at;  // its content follows
        return false;
      }
      if (opcode == Ros1Record::chunk) chunk_at = at, listed_.push_back({at, 0});
      if (opcode == Ros1Record::index && chunk_at > 0) listed_.push_back({chunk_at, at});
      if (opcode == Ros1Record::connection)
        add_connection(record, file_.bytes(record.data_at, std::min(record.data_size, kMaxConnection)));
      if (listed_.size() > kMaxListed) refuse(name_, "has more than ", kMaxListed, " chunks and lists");
      at = record.end();
    }
    return true;
  }

  void add_connection(const Ros1Record& record, std::string_view data) {
    const std::uint32_t id = record.number("conn", name_);
    if (topic_of_.count(id) > 0) return;  // listed again behind the chunks
    topic_of_[id] =
        add_topic({text_in(record.values, "topic"), text_in(named_values(data, name_), "type"), "ros1"});
  }

  void add_index(std::uint64_t chunk_at, const Ros1Record& record) {
    constexpr std::uint64_t kEntry = 12;
    const std::uint32_t connection = record.number("conn", name_);
    if (record.number("ver", name_) != 1 || record.data_size > kMaxPlaces * kEntry)
      refuse(name_, "has a list of messages of another version, or with too many messages");
    const auto topic = topic_of_.find(connection);
    if (topic != topic_of_.end() && !is_wanted_[topic->second]) {
      topics_[topic->second].messages += record.data_size / kEntry;
      return;
    }
    const std::string list = file_.bytes(record.data_at, record.data_size);
    MessageCursor cursor(list, WireFormat::ros1, name_);
    while (cursor.left() > 0) {
      const std::int64_t logged_ns = time_ns(cursor);
      add_message_of(connection, {logged_ns, chunk_at, cursor.u32()});
    }
  }

  // Lists the whole messages of a chunk, and counts them. Throws InputError where the chunk ends within a
  // record.
  void scan_chunk(std::uint64_t chunk_at, std::size_t& messages) {
    const auto chunk = open_chunk(chunk_at);
    for (std::uint64_t at = 0; at < chunk->size();) {
      const Ros1Record record = record_in(*chunk, at);
      if (record.data_size > chunk->size() - std::min(record.data_at, chunk->size()))
        refuse(name_, "the chunk at byte ", chunk_at, " ends within a record");
      add_record_of_chunk(*chunk, record, at);
      messages += record.opcode(name_) == Ros1Record::message ? 1 : 0;
      at = record.end();
    }
  }

  // The same for the chunk that was being written, which may end within a record, or in bytes that are none.
  void scan_open_chunk() {
    std::size_t messages = 0;
    try {
      scan_chunk(open_at_, messages);
    } catch (const InputError&) {
    }
    remark_ = "was not closed: its recorder was killed while it wrote a chunk; " + std::to_string(messages) +
              " messages of that chunk are whole and used";
  }

  // Adds the connection or the message that begins at byte `at` of the chunk.
  void add_record_of_chunk(BagChunk& chunk, const Ros1Record& record, std::uint64_t at) {
    const int opcode = record.opcode(name_);
    if (opcode == Ros1Record::connection)
      add_connection(record, chunk.view(record.data_at, record.data_size));
    if (opcode != Ros1Record::message) return;
    const auto time = record.values.find("time");
    if (time == record.values.end()) refuse(name_, "has a message without a time");
    MessageCursor cursor(time->second, WireFormat::ros1, name_);
    add_message_of(record.number("conn", name_), {time_ns(cursor), chunk.record_at(), at});
  }

  void add_message_of(std::uint32_t connection, const MessagePlace& place) {
    const auto topic = topic_of_.find(connection);
    if (topic == topic_of_.end())
      refuse(name_, "has a message of connection ", connection, ": expected one that the bag lists");
    add_message(topic->second, place);
  }

  const ByteFile file_;
  std::map<std::uint32_t, std::size_t> topic_of_;  // key: connection
  struct Listed {
    std::uint64_t chunk_at, index_at;  // index_at 0: the chunk itself
  };
  std::vector<Listed> listed_;
  bool is_closed_ = false;
  std::uint64_t open_at_ = 0;  // position of the chunk that was being written; 0: none
  mutable std::mutex mutex_;   // guards the chunk that was read last
  mutable std::unique_ptr<BagChunk> chunk_;
};

}  // namespace

std::unique_ptr<BagFile> open_ros1_bag(const std::filesystem::path& file, const WantedTopic& wanted) {
  return std::make_unique<Ros1Bag>(file, wanted);
}

namespace {

constexpr std::size_t kPiece = 1u << 20;

Decompress lz4(const std::string& subject) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION))) throw std::bad_alloc();
  const std::shared_ptr<LZ4F_dctx> context(made, LZ4F_freeDecompressionContext);
  return [subject, context](std::string_view& from, char* to, std::size_t size) {
    std::size_t taken = from.size();
    const std::size_t result = LZ4F_decompress(context.get(), to, &size, from.data(), &taken, nullptr);
    if (LZ4F_isError(result)) refuse(subject, "its LZ4 data are damaged: ", LZ4F_getErrorName(result));
    from.remove_prefix(taken);
    return size;
  };
}

Decompress zstd(const std::string& subject) {
  const std::shared_ptr<ZSTD_DCtx> context(ZSTD_createDCtx(), ZSTD_freeDCtx);
  if (!context) throw std::bad_alloc();
  return [subject, context](std::string_view& from, char* to, std::size_t size) {
    ZSTD_inBuffer in{from.data(), from.size(), 0};
    ZSTD_outBuffer out{to, size, 0};
    const std::size_t result = ZSTD_decompressStream(context.get(), &out, &in);
    if (ZSTD_isError(result)) refuse(subject, "its Zstandard data are damaged: ", ZSTD_getErrorName(result));
    from.remove_prefix(in.pos);
    return out.pos;
  };
}

Decompress bz2(const std::string& subject) {
  auto owned = std::make_unique<bz_stream>();
  if (BZ2_bzDecompressInit(owned.get(), 0, 0) != BZ_OK) throw std::bad_alloc();
  const std::shared_ptr<bz_stream> stream(owned.release(), [](bz_stream* ended) {
    BZ2_bzDecompressEnd(ended);
    delete ended;
  });
  return [subject, stream, ended = false](std::string_view& from, char* to, std::size_t size) mutable {
    if (ended) return std::size_t{0};
    stream->next_in = const_cast<char*>(from.data()), stream->avail_in = static_cast<unsigned>(from.size());
    stream->next_out = to, stream->avail_out = static_cast<unsigned>(size);
    const int result = BZ2_bzDecompress(stream.get());
    if (result == BZ_MEM_ERROR) throw std::bad_alloc();
    if (result != BZ_OK && result != BZ_STREAM_END)
      refuse(subject, "its bzip2 data are damaged: error ", result);
    ended = result == BZ_STREAM_END;
    from.remove_prefix(from.size() - stream->avail_in);
    return size - stream->avail_out;
  };
}

Decompress decompress(const std::string& kind, const std::string& subject) {
  return kind == "lz4"    ? lz4(subject)
         : kind == "zstd" ? zstd(subject)
         : kind == "bz2"  ? bz2(subject)
                          : nullptr;
}

}  // namespace

BagChunk::BagChunk(const ByteFile& file, const ChunkPlace& place) : file_(file), place_(place) {
  if (!file.has(place.stored_at, place.stored_size))
    refuse_chunk("claims ", place.stored_size, " bytes: more than the file has");
  decompress_ = decompress(place.compression, file.name());
  if (!decompress_ && !place.compression.empty() && place.compression != "none")
    refuse_chunk("compression = \"", place.compression.substr(0, 32), "\": expected lz4, zstd, bz2 or none");
  if (place.is_open) {
    decode_open();
    return;
  }
  if (!decompress_ && place.size != place.stored_size)
    refuse_chunk("is not compressed, but its stored size and its decoded size differ");
  if (decompress_ && place.size > kMaxBytes)
    refuse_chunk("claims ", place.size, " bytes when decompressed: expected up to ", kMaxBytes);
}

// Decodes until the bytes end, or until they are no longer compressed data. Sets the size to what was
// decoded.
void BagChunk::decode_open() {
  place_.size = decompress_ ? kMaxBytes : place_.stored_size;
  if (!decompress_) return;
  try {
    decode_until(kMaxBytes);
  } catch (const InputError&) {
    place_.size = decoded_.size();
  }
}

// Decodes up to byte `end`. Memory grows with the bytes that are decoded, not with the size that the chunk
// claims.
void BagChunk::decode_until(std::uint64_t end) {
  while (decoded_.size() < end) {
    if (input_left_.empty() && input_at_ < place_.stored_size) {
      input_ = file_.bytes(place_.stored_at + input_at_,
                           std::min<std::uint64_t>(kPiece, place_.stored_size - input_at_));
      input_left_ = input_, input_at_ += input_.size();
    }
    const std::size_t before = decoded_.size(), left_before = input_left_.size();
    const auto more = static_cast<std::size_t>(std::min<std::uint64_t>(kPiece, place_.size - before));
    if (decoded_.capacity() < before + more)
      decoded_.reserve(static_cast<std::size_t>(std::min<std::uint64_t>(place_.size, 2 * (before + more))));
    decoded_.resize(before + more);
    std::size_t got = 0;
    try {
      got = decompress_(input_left_, decoded_.data() + before, more);
    } catch (const InputError&) {
      decoded_.resize(before);
      throw;
    }
    decoded_.resize(before + got);
    const auto* new_bytes = reinterpret_cast<const unsigned char*>(decoded_.data() + before);
    crc_so_far_ = static_cast<std::uint32_t>(crc32_z(crc_so_far_, new_bytes, got));
    if (got == 0 && input_left_.size() == left_before)
      refuse_chunk("ends after ", before, " decompressed bytes: expected ", place_.size);
  }
}

std::string_view BagChunk::view(std::uint64_t at, std::uint64_t size) {
  if (at > place_.size || size > place_.size - at)
    refuse_chunk("has ", place_.size, " bytes: expected ", size, " at ", at);
  if (decompress_) {
    decode_until(at + size);
    return std::string_view(decoded_).substr(at, size);
  }
  decoded_ = file_.bytes(place_.stored_at + at, size);
  return decoded_;
}

void BagChunk::check() {
  if (checked_) return;
  if (decompress_) {
    decode_until(place_.size);
  } else if (place_.crc != 0) {
    crc_so_far_ = file_.crc(place_.stored_at, place_.stored_at + place_.size);
  }
  if (place_.crc != 0 && place_.crc != crc_so_far_)
    refuse_chunk("is damaged: its CRC differs from the stated one");
  checked_ = true;
}

}  // namespace remote_touch
