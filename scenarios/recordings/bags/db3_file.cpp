#include "scenarios/recordings/bags/db3_file.h"

#include <sqlite3.h>

#include <algorithm>
#include <cctype>
#include <new>

#include "core/parameters/input_error.h"
#include "scenarios/recordings/bags/byte_file.h"

namespace remote_touch {
namespace {

struct CloseBlob {
  void operator()(sqlite3_blob* blob) const { sqlite3_blob_close(blob); }
};

struct FinishQuery {
  void operator()(sqlite3_stmt* query) const { sqlite3_finalize(query); }
};
using Query = std::unique_ptr<sqlite3_stmt, FinishQuery>;

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
    if (plain) {
      uri += c;
    } else {
      uri += '%', uri += kDigits[byte >> 4], uri += kDigits[byte & 15];
    }
  }
  return uri + "?immutable=1";
}

}  // namespace

Db3File::Db3File(const std::filesystem::path& file, const WantedTopic& wanted) : name_(file.string()) {
  try {
    open(file);
    require_plain_tables();
    list_topics(wanted);
    list_messages();
  } catch (...) {  // the destructor does not run for a constructor that throws
    sqlite3_close(database_);
    throw;
  }
  sort_places();
}

Db3File::~Db3File() {
  sqlite3_close(database_);
}

void Db3File::refuse() const {
  if (sqlite3_errcode(database_) == SQLITE_NOMEM) throw std::bad_alloc();
  throw InputError(name_, std::string("cannot be read as a bag: ") + sqlite3_errmsg(database_));
}

void Db3File::open(const std::filesystem::path& file) {
  if (ByteFile(file).size() == 0) throw InputError(name_, "is empty: expected a bag");
  std::error_code none;
  const std::uintmax_t journal = std::filesystem::file_size(name_ + "-wal", none);
  if (!none && journal > 0)
    throw InputError(name_ + "-wal",
                     "holds data that were not yet written to the bag: expected a closed bag");
  const int flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_PRIVATECACHE;
  if (sqlite3_open_v2(immutable_uri(file).c_str(), &database_, flags, nullptr) != SQLITE_OK) {
    if (!database_) throw std::bad_alloc();
    refuse();
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
    refuse();
}

namespace {

Query prepared(sqlite3* database, const char* text) {
  sqlite3_stmt* query = nullptr;
  sqlite3_prepare_v2(database, text, -1, &query, nullptr);
  return Query(query);
}

}  // namespace

// Throws InputError unless both tables are plain: a view or a virtual table could run any computation for any
// time.
void Db3File::require_plain_tables() {
  for (const char* table : {"topics", "messages"}) {
    const Query query = prepared(
        database_,
        "SELECT type, sql FROM sqlite_schema WHERE name = ?1 COLLATE NOCASE AND type IN ('table', 'view')");
    if (!query) refuse();
    sqlite3_bind_text(query.get(), 1, table, -1, SQLITE_STATIC);
    const int step = sqlite3_step(query.get());
    if (step != SQLITE_ROW && step != SQLITE_DONE) refuse();
    std::string sql = step == SQLITE_ROW ? text_in(query.get(), 1) : "";
    std::transform(sql.begin(), sql.end(), sql.begin(), [](unsigned char c) { return std::toupper(c); });
    const bool plain = step == SQLITE_ROW && text_in(query.get(), 0) == "table" &&
                       sql.starts_with("CREATE TABLE") && sql.find("GENERATED") == std::string::npos &&
                       sql.find(" AS ") == std::string::npos && sql.find("AS(") == std::string::npos;
    if (!plain)
      throw InputError(name_, "has no plain table '" + std::string(table) + "': expected a bag of ROS 2");
  }
}

void Db3File::list_topics(const WantedTopic& wanted) {
  const Query query = prepared(database_, "SELECT id, name, type, serialization_format FROM topics");
  if (!query) refuse();
  int step = SQLITE_ROW;
  while ((step = sqlite3_step(query.get())) == SQLITE_ROW) {
    BagTopic topic;
    topic.name = text_in(query.get(), 1), topic.type = ros1_type(text_in(query.get(), 2));
    topic.encoding = text_in(query.get(), 3);
    if (topic_of_id_.size() == kMaxTopics)
      throw InputError(name_, "has more than " + std::to_string(kMaxTopics) + " topics");
    const auto same = std::find_if(topics_.begin(), topics_.end(), [&](const BagTopic& other) {
      return other.name == topic.name && other.type == topic.type && other.encoding == topic.encoding;
    });
    const bool is_new = same == topics_.end();
    const std::size_t index =
        is_new ? add_topic(name_, topic) : static_cast<std::size_t>(same - topics_.begin());
    if (is_new) is_wanted_.push_back(wanted(topic));
    topic_of_id_.emplace(sqlite3_column_int64(query.get(), 0), index);
  }
  if (step != SQLITE_DONE) refuse();
}

// Lists the messages without reading their data, which SQLite stores in separate pages.
void Db3File::list_messages() {
  const Query query = prepared(database_, "SELECT rowid, topic_id, timestamp FROM messages ORDER BY rowid");
  if (!query) refuse();
  int step = SQLITE_ROW;
  while ((step = sqlite3_step(query.get())) == SQLITE_ROW) {
    const auto topic = topic_of_id_.find(sqlite3_column_int64(query.get(), 1));
    if (topic == topic_of_id_.end()) continue;
    if (!is_wanted_[topic->second]) {
      ++topics_[topic->second].messages;
      continue;
    }
    const auto row = static_cast<std::uint64_t>(sqlite3_column_int64(query.get(), 0));
    add_place(name_, topic->second, {sqlite3_column_int64(query.get(), 2), 0, row});
  }
  if (step != SQLITE_DONE) refuse();
}

std::string Db3File::start(const MessagePlace& place, std::uint64_t max_bytes) const {
  const std::lock_guard lock(mutex_);
  sqlite3_blob* opened = nullptr;
  const int status = sqlite3_blob_open(database_, "main", "messages", "data",
                                       static_cast<sqlite3_int64>(place.at), 0, &opened);
  const std::unique_ptr<sqlite3_blob, CloseBlob> blob(opened);
  if (status != SQLITE_OK) refuse();
  const auto size = static_cast<std::uint64_t>(sqlite3_blob_bytes(blob.get()));
  if (size > ByteFile(name_).size())
    throw InputError(name_, "message " + std::to_string(place.at) + " claims " + std::to_string(size) +
                                " bytes: more than the file has");
  std::string bytes(std::min(size, max_bytes), '\0');
  if (sqlite3_blob_read(blob.get(), bytes.data(), static_cast<int>(bytes.size()), 0) != SQLITE_OK) refuse();
  return bytes;
}

}  // namespace remote_touch
