// Reads the files into which one long recording was divided as one bag.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag_file.h"

namespace remote_touch {

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

}  // namespace remote_touch
