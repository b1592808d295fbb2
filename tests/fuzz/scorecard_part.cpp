// Methods and scenes of the scorecard as JSON. The first byte selects one of them.
#include "runners/evaluation/scorecard/benchmark.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::scorecard_part {
namespace {

void read(std::string_view bytes) {
  if (bytes.empty()) return;
  const std::string text(bytes.substr(1));
  accepts(bytes, [&] {
    if (bytes.front() == 'm') {
      const Method method = read_method("fuzz", text);
      configuration({method}, {}, 2);
    } else {
      const BenchmarkScene scene = read_benchmark_scene("fuzz", text);
      configuration({}, {scene}, 2);
      scene.sweep({"proxy", "proxy", R"({"name": "proxy"})"}, 2);
    }
  });
}

const Registered registered("scorecard_part", read);

}  // namespace
}  // namespace remote_touch::fuzz::scorecard_part
