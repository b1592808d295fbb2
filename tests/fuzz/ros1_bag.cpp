// Bags of the kind ROS 1.
#include "tests/fuzz/shared/bag_target.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::ros1_bag {
namespace {

void read(std::string_view bytes) {
  read_bag("bag.bag", bytes);
}

const Registered registered("ros1_bag", read);

}  // namespace
}  // namespace remote_touch::fuzz::ros1_bag
