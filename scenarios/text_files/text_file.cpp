#include "scenarios/text_files/text_file.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "scenarios/text_files/refuse.h"

namespace remote_touch {

namespace {

class OpenFile {
 public:
  // Does not wait for another process to open a pipe for writing: a signal would not end that wait.
  explicit OpenFile(const std::filesystem::path& file)
      : file_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~OpenFile() {
    if (file_ >= 0) ::close(file_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  // Waits for data and reads up to size bytes. Returns the number of bytes, 0 at the end, or -1 with errno
  // set if the file cannot be read.
  ssize_t read(char* to, std::size_t size) const {
    if (file_ < 0) return -1;
    pollfd wait{file_, POLLIN, 0};
    if (::poll(&wait, 1, -1) < 0) return -1;
    return ::read(file_, to, size);
  }

 private:
  int file_;
};

}  // namespace

std::string read_text_file(const std::filesystem::path& file, const std::string& expected) {
  const OpenFile open(file);
  std::string text;
  std::array<char, 65536> piece;
  for (;;) {
    const ssize_t size = open.read(piece.data(), piece.size());
    if (size < 0) refuse(file.string(), "cannot be read (", std::strerror(errno), "): ", expected);
    if (size == 0) return text;
    text.append(piece.data(), static_cast<std::size_t>(size));
    if (text.size() > kMaxTextBytes)
      refuse(file.string(), "is longer than ", kMaxTextBytes >> 20, " MiB: ", expected);
  }
}

void require_file_or_folder(const std::filesystem::path& path) {
  std::error_code unreachable;
  const std::filesystem::file_status status = std::filesystem::status(path, unreachable);
  if (std::filesystem::exists(status) && std::filesystem::is_other(status))
    refuse(path.string(), "cannot be read (a pipe or a device): expected a file");
}

void require_file(const std::filesystem::path& file) {
  require_file_or_folder(file);
  std::error_code unreachable;
  if (std::filesystem::is_directory(file, unreachable))
    refuse(file.string(), "cannot be read (a folder): expected a file");
}

std::string read_input_text(const std::filesystem::path& file, const std::string& expected) {
  require_file(file);
  return read_text_file(file, expected);
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

}  // namespace remote_touch
