#include "runners/interfaces/cli/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {
namespace {

constexpr std::size_t kUsualWidth = 80, kLeastWidth = 40;

bool begins_character(char c) {
  return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
}

std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, begins_character));
}

// Returns where later lines begin: below the last text that two or more spaces separate from the text before
// it.
std::size_t indent_of(std::string_view line, std::size_t width) {
  const std::size_t first = std::min(line.find_first_not_of(' '), line.size());
  std::size_t indent = first + 2;
  for (std::size_t at = line.find("  ", first); at != std::string_view::npos; at = line.find("  ", at)) {
    at = line.find_first_not_of(' ', at);
    if (at == std::string_view::npos || characters(line.substr(0, at)) > width / 2) break;
    indent = characters(line.substr(0, at));
  }
  return std::min(indent, width / 2);
}

// Returns the number of bytes of the first line: up to the last space at or before the width, or up to the
// first space behind it. Spaces before the first word do not count.
std::size_t first_line(std::string_view text, std::size_t width) {
  const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
  std::size_t end = std::string_view::npos, count = characters(text.substr(0, begin));
  for (std::size_t i = begin; i < text.size(); ++i) {
    if (text[i] == ' ') {
      if (count > width) return end == std::string_view::npos ? i : end;
      end = i;
    }
    count += begins_character(text[i]) ? 1 : 0;
  }
  return count > width && end != std::string_view::npos ? end : text.size();
}

std::size_t terminal_width() {
  struct winsize size {};
  const bool is_known = ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return is_known ? std::max<std::size_t>(size.ws_col, kLeastWidth) : kUsualWidth;
}

// Writes all bytes, or returns false with errno.
bool write_all(const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t now = ::write(STDOUT_FILENO, text.data() + done, text.size() - done);
    if (now < 0 && errno != EINTR) return false;
    done += now > 0 ? static_cast<std::size_t>(now) : 0;
  }
  return true;
}

// A function of fopencookie(): a buffer has whole lines, or the beginning of one that goes on later.
ssize_t write_wrapped(void*, const char* bytes, std::size_t count) {
  std::string_view left(bytes, count);
  std::string text;
  const std::size_t width = terminal_width();
  for (std::size_t end = left.find('\n'); end != std::string_view::npos; end = left.find('\n')) {
    text += wrapped(left.substr(0, end), width);
    left.remove_prefix(end + 1);
  }
  return write_all(text.append(left)) ? static_cast<ssize_t>(count) : 0;
}

}  // namespace

std::string wrapped(std::string_view line, std::size_t width) {
  const std::string indent(indent_of(line, width), ' ');
  std::string text;
  std::string rest(line);
  while (characters(rest) > width) {
    const std::size_t end = first_line(rest, width);
    if (end == rest.size()) break;
    text += rest.substr(0, end) + "\n";
    const std::size_t next = rest.find_first_not_of(' ', end);
    if (next == std::string::npos) return text;  // spaces at the end
    rest = indent + rest.substr(next);
  }
  return text + rest + "\n";
}

void wrap_standard_output() {
  if (::isatty(STDOUT_FILENO) == 0) return;
  cookie_io_functions_t functions{};
  functions.write = write_wrapped;
  if (std::FILE* const file = ::fopencookie(nullptr, "w", functions)) {
    std::setvbuf(file, nullptr, _IOLBF, BUFSIZ);
    stdout = file;
  }
}

std::string suggestion(const std::string& word, const std::vector<std::string>& known) {
  const std::string nearest = similar_key(word, known);
  return nearest.empty() ? "" : "; did you mean " + nearest;
}

}  // namespace remote_touch
