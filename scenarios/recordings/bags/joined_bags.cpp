#include "scenarios/recordings/bags/joined_bags.h"

#include <algorithm>

namespace remote_touch {

JoinedBags::JoinedBags(const std::string& name, std::vector<std::unique_ptr<BagFile>> parts,
                       const std::vector<std::string>& part_names, const WantedTopic& wanted)
    : parts_(std::move(parts)) {
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const auto& part = parts_[p];
    add_remark(part_names[p], part->remark());
    for (std::size_t t = 0; t < part->topics().size(); ++t) {
      BagTopic topic = part->topics()[t];
      const auto same = std::find_if(topics_.begin(), topics_.end(), [&](const BagTopic& other) {
        return other.name == topic.name && other.type == topic.type && other.encoding == topic.encoding;
      });
      const std::uint64_t messages = topic.messages;
      topic.messages = 0;
      const std::size_t index =
          same == topics_.end() ? add_topic(name, topic) : static_cast<std::size_t>(same - topics_.begin());
      if (!wanted(topic)) topics_[index].messages += messages;
      for (const MessagePlace& place : part->places(t)) {
        add_place(name, index, {place.logged_ns, all_.size(), 0});
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

}  // namespace remote_touch
