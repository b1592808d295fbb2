// Bags of the kind MCAP.
#include "tests/fuzz/shared/bag_target.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::mcap {
namespace {

void read(std::string_view bytes) {
  read_bag("bag.mcap", bytes);
}

const Registered registered("mcap", read);

}  // namespace
}  // namespace remote_touch::fuzz::mcap
