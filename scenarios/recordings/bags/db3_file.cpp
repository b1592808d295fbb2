#include "scenarios/recordings/bags/db3_file.h"

#include <sqlite3.h>

#include <algorithm>
#include <cctype>
#include <new>

#include "scenarios/recordings/bags/bag_file.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {
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
    if (plain) {
      uri += c;
    } else {
      uri += '%', uri += kDigits[byte >> 4], uri += kDigits[byte & 15];
    }
  }
  return uri + "?immutable=1";
}

Query prepared(sqlite3* database, const char* text) {
  sqlite3_stmt* query = nullptr;
  sqlite3_prepare_v2(database, text, -1, &query, nullptr);
  return Query(query);
}

}  // namespace

Db3File::Db3File(const std::filesystem::path& file, const WantedTopic& wanted)
    : BagFile(file.string(), wanted) {
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

Db3File::~Db3File() {
  sqlite3_close(database_);
}

void Db3File::throw_error() const {
  if (sqlite3_errcode(database_) == SQLITE_NOMEM) throw std::bad_alloc();
  refuse(name_, "cannot be read as a bag: ", sqlite3_errmsg(database_));
}

void Db3File::open(const std::filesystem::path& file) {
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

// Throws InputError unless both tables are plain: a view or a virtual table could run any computation for any
// time.
void Db3File::require_plain_tables() {
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

template <class Visit>
void Db3File::for_rows(const char* text, const Visit& visit) {
  const Query query = prepared(database_, text);
  if (!query) throw_error();
  int step = SQLITE_ROW;
  while ((step = sqlite3_step(query.get())) == SQLITE_ROW) visit(query.get());
  if (step != SQLITE_DONE) throw_error();
}

void Db3File::list_topics() {
  for_rows("SELECT id, name, type, serialization_format FROM topics", [&](sqlite3_stmt* row) {
    BagTopic topic;
    topic.name = text_in(row, 1), topic.type = ros1_type(text_in(row, 2)), topic.encoding = text_in(row, 3);
    if (topic_of_id_.size() == kMaxTopics) refuse(name_, "has more than ", kMaxTopics, " topics");
    topic_of_id_.emplace(sqlite3_column_int64(row, 0), add_topic(topic));
  });
}

// Lists the messages without reading their data, which SQLite stores in separate pages.
void Db3File::list_messages() {
  for_rows("SELECT rowid, topic_id, timestamp FROM messages ORDER BY rowid", [&](sqlite3_stmt* row) {
    const auto topic = topic_of_id_.find(sqlite3_column_int64(row, 1));
    if (topic == topic_of_id_.end()) return;
    const auto number = static_cast<std::uint64_t>(sqlite3_column_int64(row, 0));
    add_message(topic->second, {sqlite3_column_int64(row, 2), 0, number});
  });
}

std::string Db3File::start(const MessagePlace& place, std::uint64_t max_bytes) const {
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

}  // namespace remote_touch
