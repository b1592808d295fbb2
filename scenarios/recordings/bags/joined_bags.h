// The files into which one long recording was divided, as one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag_file.h"

namespace remote_touch {

class JoinedBags final : public BagFile {
 public:
  // name: of the whole, for an InputError.
  JoinedBags(const std::string& name, std::vector<std::unique_ptr<BagFile>> parts, const WantedTopic& wanted);
  std::string start(const MessagePlace& place, std::uint64_t max_bytes) const override;

 private:
  // part of a place: a place in this list.
  struct PlaceInFile {
    const BagFile* file;
    MessagePlace place;
  };
  std::vector<std::unique_ptr<BagFile>> parts_;
  std::vector<PlaceInFile> all_;
};

}  // namespace remote_touch
