// Reads the answer of a child process about an HDF5 file. The child has read bytes of unknown origin, and may
// send anything.
#include <stdexcept>

#include "analysis/storage/hdf5_reader.h"
#include "tests/fuzz/shared/fuzz_target.h"

namespace remote_touch::fuzz::child_answer {
namespace {

// A refusal is the text that the reader of the file would report.
template <class Unpack>
void read_as(const std::string& bytes, Unpack unpack) {
  try {
    require(packed(unpack(bytes)) == bytes, "an answer is packed as it was");
  } catch (const std::runtime_error& refusal) {
    require_one_line(refusal.what(), bytes);
  }
}

void read(std::string_view bytes) {
  const std::string answer(bytes);
  read_as(answer, unpacked_summary);
  read_as(answer, unpacked_column);
}

const Registered registered("child_answer", read);

}  // namespace
}  // namespace remote_touch::fuzz::child_answer
