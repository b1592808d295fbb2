// The input of every format of an export: the result, the output and the files to write.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/hdf5_reader.h"
#include "core/kernels/kernels.h"

namespace remote_touch {

struct ExportJob {
  const Hdf5Reader& result;
  std::filesystem::path output;
  NewFiles& files;
  // Throws InputError unless the file may be written: it must be absent, or begin with `opening` as an
  // earlier export does.
  std::function<void(const std::filesystem::path& file, const std::string& opening)> require_allowed;
  const Kernels* kernels = nullptr;         // pre: set
  const std::atomic<bool>* stop = nullptr;  // when set, ends with Interrupted

  void begin(const std::filesystem::path& file, const std::string& opening) const {
    if (require_allowed) require_allowed(file, opening);
    files.begin(file);
  }
  // Throws Interrupted when the user wants the program to end.
  void go_on() const;
};

}  // namespace remote_touch
