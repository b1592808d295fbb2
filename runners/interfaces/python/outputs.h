// The file that a call writes, if it writes one.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/storage/other_processes.h"
#include "scenarios/recordings/recording.h"

namespace remote_touch {

// Throws InputError, before any work is done, unless the result can be written there. The folder must be
// writable. The file must be none of the inputs. An existing file must be a result of this project or empty,
// unless force is given. Holds the lock of the file. If the name is empty, there is no file.
class OutputFile {
 public:
  OutputFile(const std::string& file, bool force, const std::string& subject,
             const std::vector<RecordingPart>& inputs);
  // Calls write(file) while no other call uses the HDF5 library, or without_file() if there is no file.
  // Returns the result of that call.
  std::string write(const std::function<std::string(const std::string&)>& write,
                    const std::function<std::string()>& without_file) const;

 private:
  const std::string file_;
  std::optional<FileLock> lock_;
};

}  // namespace remote_touch
