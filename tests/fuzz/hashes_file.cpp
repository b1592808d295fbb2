// Files of hashes in result files.
#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/result_target.h"

namespace remote_touch::fuzz::hashes_file {
namespace {

const Registered registered("hashes_file", compare_as_results);

}  // namespace
}  // namespace remote_touch::fuzz::hashes_file
