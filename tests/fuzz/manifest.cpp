// The list of baselines. An accepted list is written, and comes back the same.
#include "runners/evaluation/regression/baselines.h"

#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/scratch_file.h"

namespace remote_touch::fuzz::manifest {
namespace {

void read(std::string_view bytes) {
  accepts(bytes, [&] {
    const auto folder = scratch_file("baselines/manifest.json", bytes).parent_path();
    for (const Baseline& baseline : read_manifest(folder).baselines) subject_of(folder, baseline);
  });
}

const Registered registered("manifest", read);

}  // namespace
}  // namespace remote_touch::fuzz::manifest
