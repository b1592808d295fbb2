#include "scenarios/recordings/bags/bag_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "scenarios/recordings/bags/db3_file.h"
#include "scenarios/recordings/bags/mcap_file.h"
#include "scenarios/recordings/bags/ros1_bag.h"
#include "scenarios/text_files/file_order.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {

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

namespace {

// Reads the files into which one long recording was divided as one bag.

class JoinedBags final : public BagFile {
 public:
  // name: path of the whole bag, for an InputError. part_names: names of the parts' files, for the remark.
  JoinedBags(const std::string& name, std::vector<std::unique_ptr<BagFile>> parts,
             const std::vector<std::string>& part_names, const WantedTopic& wanted);
  std::string start(const MessagePlace& place, std::uint64_t max_bytes) const override;

 private:
  // Adds what is wrong with a part to the remark of the whole bag.
  void add_remark(const std::string& part_name, const std::string& remark);

  // MessagePlace::part of this bag is an index into all_.
  struct PlaceInFile {
    const BagFile* file;
    MessagePlace place;
  };
  std::vector<std::unique_ptr<BagFile>> parts_;
  std::vector<PlaceInFile> all_;
};

JoinedBags::JoinedBags(const std::string& name, std::vector<std::unique_ptr<BagFile>> parts,
                       const std::vector<std::string>& part_names, const WantedTopic& wanted)
    : BagFile(name, wanted), parts_(std::move(parts)) {
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const auto& part = parts_[p];
    add_remark(part_names[p], part->remark());
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

void JoinedBags::add_remark(const std::string& part_name, const std::string& remark) {
  if (remark.empty()) return;
  remark_ += (remark_.empty() ? "" : "; ") + part_name + " " + remark;
}

std::string JoinedBags::start(const MessagePlace& place, std::uint64_t max_bytes) const {
  const PlaceInFile& found = all_[place.part];
  return found.file->start(found.place, max_bytes);
}

}  // namespace

namespace fs = std::filesystem;

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

namespace {

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
  if (has_ending(file, ".mcap")) return std::make_unique<McapFile>(file, wanted);
  if (has_ending(file, ".db3")) return std::make_unique<Db3File>(file, wanted);
  return std::make_unique<Ros1Bag>(file, wanted);
}

}  // namespace

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
