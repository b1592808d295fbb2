// Headers of PLY files, which are checked before a library reads the file.
#include "runners/experiment/mesh_files/mesh_file.h"

#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/scratch_file.h"

namespace remote_touch::fuzz::ply_header {
namespace {

void read(std::string_view bytes) {
  const std::string problem = ply_problem(scratch_file("header.ply", bytes));
  if (!problem.empty()) accepts(bytes, [&] { throw InputError("header.ply", problem); });
}

const Registered registered("ply_header", read);

}  // namespace
}  // namespace remote_touch::fuzz::ply_header
