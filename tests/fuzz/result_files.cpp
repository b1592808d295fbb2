// Two results of any kind, as text (content_text.h), separated by a line "---": they are read and compared.
// Traces are also hashed, and compared within tolerances.
#include "runners/evaluation/regression/result_comparison.h"
#include "tests/fuzz/shared/content_text.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::result_files {
namespace {

void compare_as_results(std::string_view bytes) {
  const auto [first, second] = two_parts(bytes);
  const Content a = content_of(first), b = content_of(second);
  accepts(bytes, [&] { report_of(compare_results(reader_of(a), reader_of(b), {})); });
  accepts(bytes, [&] {
    const Outcome outcome = compare_results(reader_of(a), reader_of(a), {}).outcome;
    require(outcome == Outcome::same || outcome == Outcome::not_comparable,
            "a result does not differ from itself");
  });
}

void compare_as_traces(std::string_view bytes) {
  compare_as_results(bytes);
  const auto [first, second] = two_parts(bytes);
  const Content a = content_of(first), b = content_of(second);
  accepts(bytes, [&] { hashes_of_trace(StoredTrace(reader_of(a)), 3); });
  accepts(bytes, [&] { compare_results(reader_of(a), reader_of(b), {{{"*", {1e-6, 0.1}}}}); });
}

const Registered of_figures("figure_file", compare_as_results);
const Registered of_hashes("hashes_file", compare_as_results);
const Registered of_traces("trace_file", compare_as_traces);

}  // namespace
}  // namespace remote_touch::fuzz::result_files
