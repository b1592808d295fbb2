#include "scenarios/recordings/bags/joined_bags.h"

#include <utility>

namespace remote_touch {

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

}  // namespace remote_touch
