#include "tests/fuzz/shared/fuzz_target.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>

namespace remote_touch::fuzz {

std::vector<Target>& targets() {
  static std::vector<Target> list;
  return list;
}

void require(bool is_true, const char* what) {
  if (!is_true) throw std::logic_error(std::string("not true: ") + what);
}

void require_one_line(const std::string& message, std::string_view bytes) {
  const auto is_control = [](unsigned char c) { return c < 0x20 || c == 0x7f; };
  require(!message.empty() && std::none_of(message.begin(), message.end(), is_control),
          "a refusal is one line");
  const auto has = [](const std::string& text, const char* word) {
    return text.find(word) != std::string::npos;
  };
  const std::string quoted = printable(std::string(bytes));
  for (const char* of_a_library :
       {"json.exception.", "std::bad_", "basic_string::_M", "basic_string::at", "basic_string::substr",
        "vector::_M", "map::at", "locale::facet", "std::vector larger", "std::get: ", "std::exception",
        "basic_string: construction", "basic_ios::clear"})
    require(!has(message, of_a_library) || has(quoted, of_a_library), "no library speaks to the user");
}

namespace fs = std::filesystem;

namespace {

class ScratchFolder {
 public:
  ScratchFolder() : path_(fs::temp_directory_path() / ("remote-touch-fuzz-" + std::to_string(::getpid()))) {
    fs::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

fs::path scratch_file(const std::string& name, std::string_view bytes) {
  static const ScratchFolder folder;
  const fs::path file = folder.path() / name;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  if (!out.is_open()) {
    fs::create_directories(file.parent_path());
    out.open(file, std::ios::binary | std::ios::trunc);
  }
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
  return file;
}

}  // namespace remote_touch::fuzz
