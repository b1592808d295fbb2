// The file that a call writes, if it writes one.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/storage/file_lock.h"
#include "scenarios/recordings/recording_part.h"

namespace remote_touch {

// Throws InputError, before any work is done, unless the result can be written there: in a writable folder,
// over none of the inputs, and over nothing but a result of this project or an empty file, or with force.
// Holds the lock of the file. An empty name: no file.
class OutputFile {
 public:
  OutputFile(const std::string& file, bool force, const std::string& subject,
             const std::vector<RecordingPart>& inputs);
  // Calls write(file), alone with the HDF5 library, or without_file() where there is none; returns what that
  // returns.
  std::string write(const std::function<std::string(const std::string&)>& write,
                    const std::function<std::string()>& without_file) const;

 private:
  const std::string file_;
  std::optional<FileLock> lock_;
};

}  // namespace remote_touch
