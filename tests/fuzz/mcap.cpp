// Bags of the kind MCAP.
#include "tests/fuzz/bag_target.h"
#include "tests/fuzz/fuzz_target.h"

namespace remote_touch::fuzz::mcap {
namespace {

void read(std::string_view bytes) {
  read_bag("bag.mcap", bytes);
}

const Registered registered("mcap", read);

}  // namespace
}  // namespace remote_touch::fuzz::mcap
