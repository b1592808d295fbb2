// The tallies of data/studies, which are compiled into the program: studies that take hours.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "analysis/tally/tally_file.h"

namespace remote_touch {

struct EmbeddedFile {
  const char* name;  // name of the file without its ending
  std::string_view bytes;
};
std::span<const EmbeddedFile> embedded_studies();

// Returns the tally of data/studies/NAME.h5. Throws InputError if there is none of this name.
StoredTally stored_study(const std::string& name);

}  // namespace remote_touch
