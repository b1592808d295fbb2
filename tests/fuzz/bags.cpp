// Bags of each kind: a file is opened, and its content read as the program does.
#include <algorithm>

#include "scenarios/recordings/bag_file.h"
#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/scratch_file.h"

namespace remote_touch::fuzz::bags {
namespace {

// name: of the file, with the ending of its kind.
void read_bag(const std::string& name, std::string_view bytes) {
  // Zeros compress to almost nothing. Such a message is read, but its cloud takes more than 1 s with
  // sanitizers.
  constexpr std::size_t kMaxMessages = 100, kMaxDecoded = 100'000;
  std::size_t longest = 0;
  const auto file = scratch_file(name, bytes);
  accepts(bytes, [&] {
    const auto bag = open_bag(file, [](const BagTopic&) { return true; });
    for (std::size_t t = 0; t < bag->topics().size(); ++t) {
      const auto& places = bag->places(t);
      require(std::is_sorted(places.begin(), places.end(),
                             [](const auto& a, const auto& b) { return a.logged_ns < b.logged_ns; }),
              "messages are in the order of their times");
      for (std::size_t i = 0; i < std::min(places.size(), kMaxMessages); ++i) {
        const std::string start = bag->start(places[i], 16), whole = bag->message(places[i]);
        longest = std::max({longest, whole.size(), places.size() > kMaxMessages ? kMaxDecoded + 1 : 0});
        require(start == whole.substr(0, 16), "the start of a message is that of the message");
      }
    }
  });
  if (longest > kMaxDecoded) return;
  accepts(bytes, [&] {
    BagChoice choice;
    choice.frame_id = bytes.size() % 2 == 0 ? "" : "base";
    const BagFrames frames(file, choice);
    for (std::size_t i = 0; i < std::min<std::size_t>(frames.captured_s().size(), 5); ++i) {
      const PointCloud cloud = frames.cloud(i, 4);
      for (const double z_m : cloud.z) require(!(z_m > 4), "a depth is in range or NaN");
    }
  });
}

const Registered of_sqlite("db3", [](std::string_view bytes) { read_bag("bag.db3", bytes); });
const Registered of_mcap("mcap", [](std::string_view bytes) { read_bag("bag.mcap", bytes); });
const Registered of_ros1("ros1_bag", [](std::string_view bytes) { read_bag("bag.bag", bytes); });

}  // namespace
}  // namespace remote_touch::fuzz::bags
