// Entries for BibTeX: of the program, and of its results.
#pragma once

#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"

namespace remote_touch {

// Returns the text of printable() such that TeX prints it as it is: characters with a meaning in TeX or
// BibTeX are escaped, and "--" does not become a dash. Braces are always balanced.
std::string bibtex_text(const std::string& text);

// The entry "@phdthesis{ryden_2013, ...}" of the dissertation, the source of the method.
std::string dissertation_entry();

// The entry "@software{remote_touch_COMMIT, ...}" of the program that wrote these attributes of a result, or
// of this program if they come from provenance(). It has the SHA-256 of the sources if the commit alone does
// not identify them.
std::string program_entry(const TextAttributes& attributes);

struct CitedResult {
  std::string file;
  std::string kind;                        // "trace"
  std::string title = {};                  // one line; empty: the entry has the name of the file instead
  std::string digest = {};                 // "digest ...", or another text that identifies the content
  std::vector<std::string> commands = {};  // make it again; may be empty
  std::string remark = {};  // why there are no commands, or what to know about them; may be empty
};
// The entry "@misc{FILE, ...}" of a result with these attributes. It has no date, because a result stores
// none, and no author, because a result does not know who ran the program. Commands that printable() would
// shorten or change are replaced with the call of `repro` that prints them.
std::string result_entry(const CitedResult& result, const TextAttributes& attributes);

}  // namespace remote_touch
