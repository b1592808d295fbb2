#include "scenarios/recordings/bag_file.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <map>
#include <mutex>
#include <new>
#include <utility>

#include "scenarios/files/input_files.h"

namespace remote_touch {

namespace fs = std::filesystem;

namespace {

struct Close {
  void operator()(sqlite3_blob* blob) const { sqlite3_blob_close(blob); }
  void operator()(sqlite3_stmt* query) const { sqlite3_finalize(query); }
};
using Query = std::unique_ptr<sqlite3_stmt, Close>;

std::string text_in(sqlite3_stmt* row, int column) {
  const unsigned char* text = sqlite3_column_text(row, column);
  return text ? std::string(reinterpret_cast<const char*>(text),
                            static_cast<std::size_t>(sqlite3_column_bytes(row, column)))
              : std::string();
}

// Returns the path as a URI which states to SQLite that nobody changes the file.
std::string immutable_uri(const std::filesystem::path& file) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(file).string()) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (byte >= '0' && byte <= '9') || (byte >= 'a' && byte <= 'z') ||
                       (byte >= 'A' && byte <= 'Z') || byte == '/' || byte == '.' || byte == '_' ||
                       byte == '-';
    constexpr const char* kDigits = "0123456789ABCDEF";
    uri += plain ? std::string(1, c) : std::string{'%', kDigits[byte >> 4], kDigits[byte & 15]};
  }
  return uri + "?immutable=1";
}

Query prepared(sqlite3* database, const char* text) {
  sqlite3_stmt* query = nullptr;
  sqlite3_prepare_v2(database, text, -1, &query, nullptr);
  return Query(query);
}

// Bags of ROS 2 in databases of SQLite (.db3): the tables `topics` and `messages` as rosbag2 makes them. The
// database is opened read-only and declared as one that nobody changes. Only plain tables are read, so that
// no text of the file is run as a query.
class Db3File final : public BagFile {
 public:
  Db3File(const std::filesystem::path& file, const WantedTopic& wanted) : BagFile(file.string(), wanted) {
    try {
      open(file);
      require_plain_tables();
      list_topics();
      list_messages();
    } catch (...) {  // the destructor does not run for a constructor that throws
      sqlite3_close(database_);
      throw;
    }
    sort_places();
  }

  ~Db3File() override { sqlite3_close(database_); }

  std::string start(const MessagePlace& place, std::uint64_t max_bytes) const override {
    const std::lock_guard lock(mutex_);
    sqlite3_blob* opened = nullptr;
    const int status = sqlite3_blob_open(database_, "main", "messages", "data",
                                         static_cast<sqlite3_int64>(place.at), 0, &opened);
    const std::unique_ptr<sqlite3_blob, Close> blob(opened);
    if (status != SQLITE_OK) throw_error();
    const auto size = static_cast<std::uint64_t>(sqlite3_blob_bytes(blob.get()));
    if (size > ByteFile(name_).size())
      refuse(name_, "message ", place.at, " claims ", size, " bytes: more than the file has");
    std::string bytes(std::min(size, max_bytes), '\0');
    if (sqlite3_blob_read(blob.get(), bytes.data(), static_cast<int>(bytes.size()), 0) != SQLITE_OK)
      throw_error();
    return bytes;
  }

 private:
  void open(const std::filesystem::path& file) {
    if (ByteFile(file).size() == 0) refuse(name_, "is empty: expected a bag");
    std::error_code none;
    const std::uintmax_t journal = std::filesystem::file_size(name_ + "-wal", none);
    if (!none && journal > 0)
      refuse(name_ + "-wal", "holds data that were not yet written to the bag: expected a closed bag");
    const int flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_PRIVATECACHE;
    if (sqlite3_open_v2(immutable_uri(file).c_str(), &database_, flags, nullptr) != SQLITE_OK) {
      if (!database_) throw std::bad_alloc();
      throw_error();
    }
    constexpr int kMaxText = 1 << 20;
    sqlite3_limit(database_, SQLITE_LIMIT_LENGTH, static_cast<int>(kMaxMessageBytes));
    sqlite3_limit(database_, SQLITE_LIMIT_SQL_LENGTH, kMaxText);
    sqlite3_limit(database_, SQLITE_LIMIT_EXPR_DEPTH, 20);
    sqlite3_limit(database_, SQLITE_LIMIT_TRIGGER_DEPTH, 1);
    sqlite3_limit(database_, SQLITE_LIMIT_ATTACHED, 0);
    sqlite3_db_config(database_, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(database_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(database_, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
    sqlite3_db_config(database_, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
    if (sqlite3_exec(database_, "PRAGMA cell_size_check=1; PRAGMA mmap_size=0; PRAGMA cache_size=-8192",
                     nullptr, nullptr, nullptr) != SQLITE_OK)
      throw_error();
  }

  // Throws InputError unless both tables are plain: a view or a virtual table could run any computation for
  // any time.
  void require_plain_tables() {
    for (const char* table : {"topics", "messages"}) {
      const Query query = prepared(
          database_,
          "SELECT type, sql FROM sqlite_schema WHERE name = ?1 COLLATE NOCASE AND type IN ('table', 'view')");
      if (!query) throw_error();
      sqlite3_bind_text(query.get(), 1, table, -1, SQLITE_STATIC);
      const int step = sqlite3_step(query.get());
      if (step != SQLITE_ROW && step != SQLITE_DONE) throw_error();
      std::string sql = step == SQLITE_ROW ? text_in(query.get(), 1) : "";
      std::transform(sql.begin(), sql.end(), sql.begin(), [](unsigned char c) { return std::toupper(c); });
      const bool plain = step == SQLITE_ROW && text_in(query.get(), 0) == "table" &&
                         sql.starts_with("CREATE TABLE") && sql.find("GENERATED") == std::string::npos &&
                         sql.find(" AS ") == std::string::npos && sql.find("AS(") == std::string::npos;
      if (!plain) refuse(name_, "has no plain table '", table, "': expected a bag of ROS 2");
    }
  }

  // Calls visit(row) for each row of the query `text`.
  template <class Visit>
  void for_rows(const char* text, const Visit& visit) {
    const Query query = prepared(database_, text);
    if (!query) throw_error();
    int step = SQLITE_ROW;
    while ((step = sqlite3_step(query.get())) == SQLITE_ROW) visit(query.get());
    if (step != SQLITE_DONE) throw_error();
  }

  void list_topics() {
    for_rows("SELECT id, name, type, serialization_format FROM topics", [&](sqlite3_stmt* row) {
      BagTopic topic;
      topic.name = text_in(row, 1), topic.type = ros1_type(text_in(row, 2)), topic.encoding = text_in(row, 3);
      if (topic_of_id_.size() == kMaxTopics) refuse(name_, "has more than ", kMaxTopics, " topics");
      topic_of_id_.emplace(sqlite3_column_int64(row, 0), add_topic(topic));
    });
  }

  // Lists the messages without reading their data, which SQLite stores in separate pages.
  void list_messages() {
    for_rows("SELECT rowid, topic_id, timestamp FROM messages ORDER BY rowid", [&](sqlite3_stmt* row) {
      const auto topic = topic_of_id_.find(sqlite3_column_int64(row, 1));
      if (topic == topic_of_id_.end()) return;
      const auto number = static_cast<std::uint64_t>(sqlite3_column_int64(row, 0));
      add_message(topic->second, {sqlite3_column_int64(row, 2), 0, number});
    });
  }

  [[noreturn]] void throw_error() const {
    if (sqlite3_errcode(database_) == SQLITE_NOMEM) throw std::bad_alloc();
    refuse(name_, "cannot be read as a bag: ", sqlite3_errmsg(database_));
  }

  sqlite3* database_ = nullptr;
  std::map<std::int64_t, std::size_t> topic_of_id_;  // topic of each id in the database
  mutable std::mutex mutex_;                         // guards the database
};

// Reads the files into which one long recording was divided as one bag.
class JoinedBags final : public BagFile {
 public:
  // name: path of the whole bag, for an InputError. part_names: names of the parts' files, for the remark.
  JoinedBags(const std::string& name, std::vector<std::unique_ptr<BagFile>> parts,
             const std::vector<std::string>& part_names, const WantedTopic& wanted)
      : BagFile(name, wanted), parts_(std::move(parts)) {
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      const auto& part = parts_[p];
      if (!part->remark().empty())
        remark_ += (remark_.empty() ? "" : "; ") + part_names[p] + " " + part->remark();
      for (std::size_t t = 0; t < part->topics().size(); ++t) {
        BagTopic topic = part->topics()[t];
        const std::uint64_t messages = std::exchange(topic.messages, 0);
        const std::size_t index = add_topic(topic);
        if (!is_wanted_[index]) topics_[index].messages += messages;
        for (const MessagePlace& place : part->places(t)) {  // empty unless the topic is wanted
          add_message(index, {place.logged_ns, all_.size(), 0});
          all_.push_back({part.get(), place});
        }
      }
    }
    sort_places();
  }

  std::string start(const MessagePlace& place, std::uint64_t max_bytes) const override {
    const PlaceInFile& found = all_[place.part];
    return found.file->start(found.place, max_bytes);
  }

 private:
  // MessagePlace::part of this bag is an index into all_.
  struct PlaceInFile {
    const BagFile* file;
    MessagePlace place;
  };
  std::vector<std::unique_ptr<BagFile>> parts_;
  std::vector<PlaceInFile> all_;
};

bool is_bag_file(const fs::path& file) {
  return has_ending(file, ".mcap") || has_ending(file, ".db3") || has_ending(file, ".bag");
}

// Returns the bag files of a folder: ROS 2 divides a long recording into several. Empty if the folder cannot
// be read.
std::vector<fs::path> parts_of(const fs::path& folder) {
  std::vector<fs::path> parts;
  std::error_code refused;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, refused))
    if (!is_hidden(entry.path()) && (has_ending(entry.path(), ".mcap") || has_ending(entry.path(), ".db3")))
      parts.push_back(entry.path());
  sort_by_name(parts);
  return parts;
}

std::unique_ptr<BagFile> open_file(const fs::path& file, const WantedTopic& wanted) {
  if (has_ending(file, ".mcap")) return open_mcap(file, wanted);
  if (has_ending(file, ".db3")) return std::make_unique<Db3File>(file, wanted);
  return open_ros1_bag(file, wanted);
}

}  // namespace

ByteFile::ByteFile(const std::filesystem::path& file) : name_(file.string()) {
  descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat status {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
    const std::string why = std::strerror(errno);
    if (descriptor_ >= 0) ::close(descriptor_);
    refuse(name_, "cannot be opened: ", why);
  }
  if (!S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    refuse(name_, "is not a file: expected a bag");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

ByteFile::~ByteFile() {
  ::close(descriptor_);
}

std::string ByteFile::bytes(std::uint64_t at, std::uint64_t size) const {
  if (!has(at, size)) refuse(name_, "ends at byte ", size_, ": expected ", size, " bytes at ", at);
  std::string result(size, '\0');
  read(at, result.data(), result.size());
  return result;
}

void ByteFile::read(std::uint64_t at, char* to, std::size_t size) const {
  while (size > 0) {
    const ssize_t got = ::pread(descriptor_, to, size, static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) refuse(name_, "cannot be read: ", std::strerror(errno));
    if (got == 0) refuse(name_, "ends while it is read");
    at += static_cast<std::uint64_t>(got), to += got, size -= static_cast<std::size_t>(got);
  }
}

std::uint32_t ByteFile::crc(std::uint64_t at, std::uint64_t end) const {
  uLong crc = 0;
  for (std::string piece; at < end; at += piece.size()) {
    piece = bytes(at, std::min<std::uint64_t>(1u << 20, end - at));
    crc = crc32_z(crc, reinterpret_cast<const unsigned char*>(piece.data()), piece.size());
  }
  return static_cast<std::uint32_t>(crc);
}

std::string ros1_type(const std::string& type) {
  const std::size_t at = type.find("/msg/");
  return at == std::string::npos ? type : type.substr(0, at) + type.substr(at + 4);
}

std::size_t BagFile::add_topic(const BagTopic& topic) {
  constexpr std::size_t kMaxName = 1024;
  const auto same = std::find_if(topics_.begin(), topics_.end(), [&](const BagTopic& other) {
    return other.name == topic.name && other.type == topic.type && other.encoding == topic.encoding;
  });
  if (same != topics_.end()) return static_cast<std::size_t>(same - topics_.begin());
  if (topics_.size() == kMaxTopics) refuse(name_, "has more than ", kMaxTopics, " topics");
  if (std::max({topic.name.size(), topic.type.size(), topic.encoding.size()}) > kMaxName)
    refuse(name_, "names a topic or a type with more than ", kMaxName, " bytes");
  topics_.push_back(topic), places_.emplace_back(), is_wanted_.push_back(wanted_(topic));
  return topics_.size() - 1;
}

void BagFile::add_message(std::size_t topic, const MessagePlace& place) {
  if (!is_wanted_[topic]) {
    ++topics_[topic].messages;
    return;
  }
  if (places_[topic].size() == kMaxPlaces)
    refuse(name_, "has more than ", kMaxPlaces, " messages of ", topics_[topic].name);
  places_[topic].push_back(place);
}

void BagFile::require_length(std::uint64_t bytes) const {
  if (bytes > kMaxMessageBytes)
    refuse(name_, "a message has ", bytes, " bytes: expected up to ", kMaxMessageBytes);
}

void BagFile::sort_places() {
  for (std::size_t t = 0; t < topics_.size(); ++t) {
    std::vector<MessagePlace>& places = places_[t];
    std::stable_sort(places.begin(), places.end(),
                     [](const MessagePlace& a, const MessagePlace& b) { return a.logged_ns < b.logged_ns; });
    if (!places.empty()) topics_[t].messages = places.size();
  }
}

bool is_bag(const fs::path& path) {
  std::error_code refused;
  if (!fs::is_directory(path, refused)) return is_bag_file(path);
  return fs::exists(path / "metadata.yaml", refused) && !parts_of(path).empty();
}

std::vector<fs::path> files_of_bag(const fs::path& path) {
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> files = parts_of(path);
  files.push_back(path / "metadata.yaml");
  return files;
}

std::unique_ptr<BagFile> open_bag(const fs::path& path, const WantedTopic& wanted) {
  if (!fs::is_directory(path)) return open_file(path, wanted);
  std::vector<std::unique_ptr<BagFile>> parts;
  std::vector<std::string> names;
  for (const fs::path& part : parts_of(path)) {
    parts.push_back(open_file(part, wanted));
    names.push_back(part.filename().string());
  }
  if (parts.size() == 1) return std::move(parts.front());
  return std::make_unique<JoinedBags>(path.string(), std::move(parts), names, wanted);
}

}  // namespace remote_touch
