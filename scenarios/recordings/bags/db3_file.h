// Bags of ROS 2 in databases of SQLite (.db3).
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag_file.h"

struct sqlite3;

namespace remote_touch {

// The tables `topics` and `messages` as rosbag2 makes them. The database is opened read-only and declared as
// one that nobody changes. Only plain tables are read, so that no text of the file is run as a query.
class Db3File final : public BagFile {
 public:
  Db3File(const std::filesystem::path& file, const WantedTopic& wanted);
  ~Db3File() override;
  std::string start(const MessagePlace& place, std::uint64_t max_bytes) const override;

 private:
  void open(const std::filesystem::path& file);
  void require_plain_tables();
  // Calls visit(row) for each row of the query.
  template <class Visit>
  void for_rows(const char* query, const Visit& visit);
  void list_topics();
  void list_messages();
  [[noreturn]] void throw_error() const;

  sqlite3* database_ = nullptr;
  std::map<std::int64_t, std::size_t> topic_of_id_;  // topic of each id in the database
  mutable std::mutex mutex_;                         // guards the database
};

}  // namespace remote_touch
