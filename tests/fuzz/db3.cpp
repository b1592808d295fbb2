// Bags of the kind SQLite.
#include "tests/fuzz/shared/bag_target.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::db3 {
namespace {

void read(std::string_view bytes) {
  read_bag("bag.db3", bytes);
}

const Registered registered("db3", read);

}  // namespace
}  // namespace remote_touch::fuzz::db3
