#include "tests/fuzz/shared/result_target.h"

#include "runners/evaluation/regression/comparison_report.h"
#include "tests/fuzz/shared/content_text.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz {

void compare_as_results(std::string_view bytes) {
  const auto [first, second] = two_parts(bytes);
  const Content a = content_of(first), b = content_of(second);
  accepts(bytes, [&] { comparison_json(compare_results(reader_of(a), reader_of(b), {})); });
  accepts(bytes, [&] {
    const Outcome outcome = compare_results(reader_of(a), reader_of(a), {}).outcome;
    require(outcome == Outcome::same || outcome == Outcome::not_comparable,
            "a result does not differ from itself");
  });
}

}  // namespace remote_touch::fuzz
