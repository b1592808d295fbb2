// Tests bags of all kinds, intact and damaged. Bags of other writers are tested in tests/system/bags.
#include "scenarios/recordings/bag_file.h"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/bag_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::bag_file_test {
namespace {

const WantedTopic kAll = [](const BagTopic&) { return true; };

// Ten messages of two topics, in the order in which the recorder received them: 3 after 4.
std::vector<BagMessage> messages() {
  std::vector<BagMessage> list;
  for (const int i : {0, 1, 2, 4, 3}) {
    list.push_back(
        {"/a", "sensor_msgs/msg/PointCloud2", 100 + i, "a" + std::to_string(i) + std::string(50, 'x')});
    list.push_back({"/b", "std_msgs/msg/Float32", 200 + i, "b" + std::to_string(i)});
  }
  return list;
}

class Bags : public ::testing::Test {
 protected:
  std::unique_ptr<BagFile> open(const std::string& name, const WantedTopic& wanted = kAll) const {
    return open_bag(folder_ / name, wanted);
  }

  void expect_all(const BagFile& bag) const {
    ASSERT_EQ(bag.topics().size(), 2u);
    EXPECT_EQ(bag.topics()[0].name, "/a");
    EXPECT_EQ(bag.topics()[0].type, "sensor_msgs/PointCloud2");
    EXPECT_EQ(bag.topics()[1].type, "std_msgs/Float32");
    ASSERT_EQ(bag.places(0).size(), 5u);
    ASSERT_EQ(bag.places(1).size(), 5u);
    EXPECT_EQ(bag.topics()[0].messages, 5u);
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_EQ(bag.places(0)[i].logged_ns, 100 + static_cast<int>(i));
      EXPECT_EQ(bag.message(bag.places(0)[i]), "a" + std::to_string(i) + std::string(50, 'x'));
      EXPECT_EQ(bag.start(bag.places(0)[i], 2), "a" + std::to_string(i));
    }
    EXPECT_EQ(bag.message(bag.places(1)[3]), "b3");
  }

  std::string error(const std::string& name) const {
    return refusal([&] {
      const auto bag = open(name);
      for (std::size_t t = 0; t < bag->topics().size(); ++t)
        for (const MessagePlace& place : bag->places(t)) bag->message(place);
    });
  }

  // Runs the text in a database, which is made if there is none.
  void change_database(const std::string& name, const std::string& text) const {
    sqlite3* database = nullptr;
    sqlite3_open((folder_ / name).c_str(), &database);
    EXPECT_EQ(sqlite3_exec(database, text.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database);
    sqlite3_close(database);
  }

  const TestFolder folder_{"bag_file_test"};
};

// A summary need not repeat the schemas, and its records have no order.
TEST_F(Bags, McapIsReadInEveryLayout) {
  for (const char* compression : {"", "lz4", "zstd"})
    for (const bool chunks : {true, false})
      for (const bool index : {true, false})
        for (const bool repeats_schemas : {true, false})
          for (const bool channels_first : {true, false}) {
            if (!chunks && compression[0] != '\0') continue;
            SCOPED_TRACE(testing::Message()
                         << compression << chunks << index << repeats_schemas << channels_first);
            McapLayout layout{chunks, index, true, compression};
            layout.repeats_schemas = repeats_schemas, layout.channels_first = channels_first;
            folder_.write("x.mcap", mcap_file(messages(), layout));
            const auto bag = open("x.mcap");
            expect_all(*bag);
            EXPECT_EQ(bag->remark().empty(), index || !chunks) << bag->remark();
          }
}

TEST_F(Bags, Ros1IsReadInEveryLayout) {
  for (const char* compression : {"none", "lz4", "bz2"})
    for (const bool closed : {true, false}) {
      folder_.write("x.bag", ros1_file(messages(), compression, closed));
      const auto bag = open("x.bag");
      expect_all(*bag);
      EXPECT_EQ(bag->remark(), closed ? "" : "was not closed: it was read from end to end");
    }
}

// A recorder that is killed leaves an open chunk, whose record claims 0 bytes: the messages follow behind it,
// as far as they were written. Cut anywhere, it gives what is whole of them, and no error.
TEST_F(Bags, ARos1BagOfAKilledRecorderIsReadAsFarAsItWasWritten) {
  const std::vector<BagMessage> all = messages();
  for (const char* compression : {"none", "lz4", "bz2"}) {
    SCOPED_TRACE(compression);
    const std::string begun = ros1_file({all.begin(), all.begin() + 4}, compression, false);
    std::string open_chunk = ros1_file({all.begin() + 4, all.end()}, compression, false);
    const auto number = [&](std::size_t at) {
      std::uint32_t value = 0;
      std::memcpy(&value, open_chunk.data() + at, sizeof value);
      return value;
    };
    std::size_t at = 13;
    at += 4 + number(at), at += 4 + number(at);  // the record of the bag
    open_chunk.erase(0, at);
    const std::size_t size_at = open_chunk.find("size=") + 5, data_at = 4 + number(0);
    const std::uint32_t data_size = number(data_at);
    for (int i = 0; i < 4; ++i) open_chunk[size_at + i] = open_chunk[data_at + i] = '\0';
    std::size_t most = 0;
    for (std::size_t written = 0; written <= data_size; ++written) {
      folder_.write("x.bag", begun + open_chunk.substr(0, data_at + 4 + written));
      const auto bag = open("x.bag");
      const std::size_t found = bag->places(0).size() + bag->places(1).size();
      EXPECT_GE(found, std::max<std::size_t>(4, most));
      most = found;
      for (std::size_t t = 0; t < 2; ++t)
        for (const MessagePlace& place : bag->places(t)) EXPECT_FALSE(bag->message(place).empty());
      EXPECT_EQ(bag->remark(), "was not closed: its recorder was killed while it wrote a chunk; " +
                                   std::to_string(found - 4) + " messages of that chunk are whole and used");
    }
    EXPECT_EQ(most, 10u);
  }
}

TEST_F(Bags, SqliteIsReadAlsoAsFolders) {
  write_db3((folder_ / "a b?#%.db3").string(), messages());
  expect_all(*open("a b?#%.db3"));
  const std::vector<BagMessage> all = messages();
  folder_.write("split/metadata.yaml", "");
  write_db3((folder_ / "split/x_9.db3").string(), {all.begin(), all.begin() + 4});
  write_db3((folder_ / "split/x_10.db3").string(), {all.begin() + 4, all.end()});
  ASSERT_TRUE(is_bag(folder_ / "split"));
  expect_all(*open("split"));
  EXPECT_EQ(files_of_bag(folder_ / "split").front().filename(), "x_9.db3");
  EXPECT_FALSE(is_bag(folder_.path()));
}

TEST_F(Bags, ListOnlyTheMessagesOfWantedTopics) {
  const WantedTopic only_b = [](const BagTopic& topic) { return topic.name == "/b"; };
  folder_.write("x.mcap", mcap_file(messages())), folder_.write("x.bag", ros1_file(messages()));
  folder_.write("y.mcap", mcap_file(messages(), {true, false}));
  write_db3((folder_ / "x.db3").string(), messages());
  for (const char* name : {"x.mcap", "y.mcap", "x.bag", "x.db3"}) {
    const auto bag = open(name, only_b);
    EXPECT_TRUE(bag->places(0).empty()) << name;
    EXPECT_EQ(bag->topics()[0].messages, 5u) << name;
    EXPECT_EQ(bag->places(1).size(), 5u) << name;
  }
}

// A bag that is cut at any byte is read as far as it goes, or refused in one line. A longer piece never has
// fewer messages.
TEST_F(Bags, ABagThatIsCutShortIsReadAsFarAsItGoes) {
  const std::string whole = mcap_file(messages(), {true, true, true, "lz4"});
  std::size_t most = 0;
  for (std::size_t size = 0; size < whole.size(); size += 5) {
    folder_.write("x.mcap", whole.substr(0, size));
    const std::string text = refusal([&] {
      const auto bag = open("x.mcap");
      EXPECT_FALSE(bag->remark().empty()) << size;
      std::size_t count = 0;
      for (std::size_t t = 0; t < bag->topics().size(); ++t) count += bag->places(t).size();
      EXPECT_GE(count, most) << size;
      most = std::max(most, count);
      for (std::size_t t = 0; t < bag->topics().size(); ++t)
        for (const MessagePlace& place : bag->places(t)) bag->message(place);
    });
    EXPECT_EQ(text == "no InputError", size >= 8) << size << " " << text;
  }
  EXPECT_EQ(most, 10u);
  const std::string bag = ros1_file(messages());
  for (std::size_t size = 13; size < bag.size(); size += 11) {
    folder_.write("x.bag", bag.substr(0, size));
    error("x.bag");
  }
}

TEST_F(Bags, ADamagedBagIsDetectedByItsCrc) {
  std::string bytes = mcap_file(messages(), {true, true, true, ""});
  const std::size_t at = bytes.find("a2xxx");
  bytes[at + 10] = 'y';
  folder_.write("x.mcap", bytes);
  EXPECT_HAS(error("x.mcap"), "its CRC differs from");
  bytes = mcap_file(messages());
  bytes[bytes.size() - 60] ^= 1;  // damages the index: the file is read from end to end instead
  folder_.write("x.mcap", bytes);
  const auto bag = open("x.mcap");
  expect_all(*bag);
  EXPECT_EQ(bag->remark(), "has a damaged index: it was read from end to end");
}

// A change of any one byte leads to a one-line error or an answer, in bounded memory; the sanitizers check
// this.
TEST_F(Bags, AChangedByteGivesAnErrorOrAnAnswer) {
  write_db3((folder_ / "y.db3").string(), messages());
  const std::string kinds[] = {mcap_file(messages(), {true, true, false, ""}), ros1_file(messages(), "lz4"),
                               bytes_of(folder_ / "y.db3")};
  const char* names[] = {"x.mcap", "x.bag", "x.db3"};
  for (int k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < kinds[k].size(); i += k == 2 ? 97 : 7) {
      std::string bytes = kinds[k];
      bytes[i] = static_cast<char>(bytes[i] ^ 0xC1);
      folder_.write(names[k], bytes);
      error(names[k]);
    }
}

TEST_F(Bags, OtherKindsAreRefused) {
  const auto is_refused = [&](const std::string& name, const std::string& bytes, const std::string& part) {
    folder_.write(name, bytes);
    EXPECT_HAS(error(name), part);
  };
  is_refused("x.mcap", "", "does not begin as an MCAP file");
  is_refused("x.mcap", std::string(100, 'x'), "does not begin as an MCAP file");
  is_refused("x.bag", "#ROSBAG V1.2\n", "is a bag of an older version");
  is_refused("x.bag", std::string(100, 'x'), "does not begin as a bag");
  is_refused("x.db3", "", "is empty");
  is_refused("x.db3", std::string(4096, 'x'), "cannot be read as a bag: file is not a database");
  EXPECT_HAS(error("none.bag"), "cannot be opened");
  folder_.write("folder.mcap/file", "");
  EXPECT_FALSE(is_bag(folder_ / "folder.mcap"));
}

// The table lists /a twice, and each entry has one message.
TEST_F(Bags, ATopicThatSqliteListsTwiceIsOneTopic) {
  write_db3((folder_ / "twice.db3").string(), {{"/a", "std_msgs/msg/Float32", 2, "second"}});
  change_database("twice.db3",
                  "INSERT INTO topics VALUES (7, '/a', 'std_msgs/msg/Float32', 'cdr', '');"
                  "INSERT INTO messages(topic_id, timestamp, data) VALUES (7, 1, x'6669727374')");
  const auto bag = open("twice.db3");
  ASSERT_EQ(bag->topics().size(), 1u);
  ASSERT_EQ(bag->places(0).size(), 2u);
  EXPECT_EQ(bag->message(bag->places(0)[0]), "first");
  EXPECT_EQ(bag->message(bag->places(0)[1]), "second");
}

TEST_F(Bags, ASplitBagReportsEveryDamagedPart) {
  const std::string whole = mcap_file(messages(), {true, true, true, "lz4"});
  folder_.write("split/metadata.yaml", "");
  folder_.write("split/x_0.mcap", whole.substr(0, whole.size() / 2));
  folder_.write("split/x_1.mcap", whole);
  folder_.write("split/x_2.mcap", whole.substr(0, whole.size() / 3));
  const auto remark = [&](const char* name) {
    return std::string(name) + " " + open(std::string("split/") + name)->remark();
  };
  EXPECT_EQ(open("split")->remark(), remark("x_0.mcap") + "; " + remark("x_2.mcap"));
}

// Tables that can run any computation, for any time.
TEST_F(Bags, HostileDatabasesAreRefused) {
  const auto made = [&](const std::string& text) {
    std::filesystem::remove(folder_ / "h.db3");
    change_database("h.db3", text);
    return error("h.db3");
  };
  const std::string topics =
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name, type, serialization_format);"
      "INSERT INTO topics VALUES (1, '/a', 'sensor_msgs/msg/Image', 'cdr');";
  EXPECT_HAS(made("CREATE TABLE other(id)"), "has no plain table 'topics'");
  EXPECT_HAS(made(topics +
                  "CREATE VIEW messages AS WITH RECURSIVE c(id) AS (SELECT 1 UNION ALL SELECT id + 1 FROM c) "
                  "SELECT id, 1 topic_id, 1 timestamp, 1 data FROM c"),
             "has no plain table 'messages'");
  EXPECT_HAS(made(topics + "CREATE TABLE messages(id, topic_id, timestamp, data AS (zeroblob(1000000000)))"),
             "has no plain table 'messages'");
  EXPECT_HAS(made(topics + "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, data);"
                           "INSERT INTO messages VALUES (1, 1, 1, NULL)"),
             "cannot be read as a bag: cannot open value of type null");
  EXPECT_HAS(made(topics + "CREATE TABLE messages(id, topic_id, timestamp, data) "), "no InputError");
}

TEST_F(Bags, AreReadByManyThreads) {
  folder_.write("x.mcap", mcap_file(messages(), {true, true, true, "zstd"}));
  const auto bag = open("x.mcap");
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < 4; ++k)
    threads.emplace_back([&, k] {
      for (std::size_t n = 0; n < 200; ++n) {
        const std::size_t i = (n * (k + 1)) % 5;
        EXPECT_EQ(bag->start(bag->places(0)[i], 2), "a" + std::to_string(i));
      }
    });
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace remote_touch::bag_file_test
