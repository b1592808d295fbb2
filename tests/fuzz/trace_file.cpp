// Traces in result files: hashed, and compared within tolerances.
#include "runners/evaluation/regression/result_comparison.h"
#include "tests/fuzz/shared/content_text.h"
#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/result_target.h"

namespace remote_touch::fuzz::trace_file {
namespace {

void read(std::string_view bytes) {
  compare_as_results(bytes);
  const auto [first, second] = two_parts(bytes);
  const Content a = content_of(first), b = content_of(second);
  accepts(bytes, [&] { hashes_of_trace(StoredTrace(reader_of(a)), 3); });
  accepts(bytes, [&] { compare_results(reader_of(a), reader_of(b), {{{"*", {1e-6, 0.1}}}}); });
}

const Registered registered("trace_file", read);

}  // namespace
}  // namespace remote_touch::fuzz::trace_file
