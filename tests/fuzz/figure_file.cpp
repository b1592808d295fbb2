// Figures in result files.
#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/result_target.h"

namespace remote_touch::fuzz::figure_file {
namespace {

const Registered registered("figure_file", compare_as_results);

}  // namespace
}  // namespace remote_touch::fuzz::figure_file
