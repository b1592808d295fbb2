// Damaged and foreign HDF5 files. The HDF5 library reads them in a child process with limits.
#include "analysis/storage/hdf5_values.h"
#include "analysis/sweeps/sweep_file.h"
#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/lasting_child.h"
#include "tests/fuzz/shared/scratch_file.h"

namespace remote_touch::fuzz::hdf5_bytes {
namespace {

void read(std::string_view bytes) {
  use_hdf5();  // it begins here, once, and not in each child
  const auto file = scratch_file("file.h5", bytes);
  accepts(bytes, [&] {
    const Hdf5Reader reader(file, run_in_child());
    if (reader.has("/sweep/checksum")) read_sweep(reader);
    for (const std::string& dataset : reader.datasets()) reader.column(dataset);
  });
}

const Registered registered("hdf5_bytes", read);

}  // namespace
}  // namespace remote_touch::fuzz::hdf5_bytes
