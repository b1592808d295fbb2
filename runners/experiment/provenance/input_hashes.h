// Hashes of the recordings that a result was made from: the attribute `input_digests` of result files.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "scenarios/recordings/recording_part.h"

namespace remote_touch {

// The text has one line for each recording, sorted by path:
//
//   PATH: 71 file(s), 4929174 bytes, sha256 HASH
//
// PATH is scenario.path as the configuration gives it, without the folder below which it was found. The files
// are those of files_of(), from which the frames first_frame to last_frame are made. HASH is the SHA-256 over
// one line for each, "<its own SHA-256>  <its name from the recording's folder>\n", the lines sorted by their
// bytes. So anybody can compute it again, for a folder and for a single PCD file:
//
//   cd PATH && sha256sum camera.json depth/0000.png depth/0001.png ... | LC_ALL=C sort | sha256sum
//   cd "$(dirname PATH)" && sha256sum "$(basename PATH)" | sha256sum
//
// If runs read different parts of one recording, its line covers the files of all of them.
class InputHashes {
 public:
  // Reads each file once. Throws InputError as files_of() does, and for a file that cannot be read.
  void add(const std::vector<RecordingPart>& parts);
  std::string text() const;  // empty: nothing was added
  // Reads the files again and throws InputError if they differ from those that were added.
  void require_unchanged() const;

 private:
  void read(const RecordingPart& part);

  struct Known {
    std::string sha256;
    std::uintmax_t size = 0;
  };
  std::map<std::string, std::map<std::string, Known>> recordings_;  // keys: path, then name
  std::set<RecordingPart> parts_;
};

std::string input_hashes(const std::vector<RecordingPart>& parts);

// before: input_hashes(parts) from before the runs. Reads the files again and throws InputError if they
// differ, so that no result states the hash of a file that its runs did not read.
void require_unchanged(const std::vector<RecordingPart>& parts, const std::string& before);

// Returns a path or name on one line, as sha256sum writes it: a backslash, line feed or carriage return in it
// is written \\, \n, \r.
std::string in_one_line(const std::string& name);

// A recording whose line differs between two texts of input_hashes().
struct ChangedInput {
  std::string path;         // written as in_one_line() does
  std::string before, now;  // the rest of the line: "71 file(s), ..."; "absent" if there is none
};
std::vector<ChangedInput> changed_inputs(const std::string& before, const std::string& now);

}  // namespace remote_touch
