#include "analysis/trace/formatted.h"

#include <cstdarg>
#include <cstdio>

namespace remote_touch {

std::string formatted(const char* format, ...) {
  std::va_list values, again;
  va_start(values, format);
  va_copy(again, values);
  std::string text(static_cast<std::size_t>(std::vsnprintf(nullptr, 0, format, values)), '\0');
  std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(values), va_end(again);
  return text;
}

}  // namespace remote_touch
