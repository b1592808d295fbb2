#include "runners/evaluation/figures/studies/stored_study.h"

#include <algorithm>

#include "core/parameters/input_error.h"

namespace remote_touch {

StoredTally stored_study(const std::string& name) {
  const auto all = embedded_studies();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const EmbeddedFile& file) { return file.name == name; });
  if (found == all.end()) throw InputError(name, "no such study: expected a file of data/studies");
  StoredTally study = read_tally(Hdf5Reader(name, open_hdf5_image(found->bytes)));
  require_trusted(name, study.attributes);
  return study;
}

}  // namespace remote_touch
