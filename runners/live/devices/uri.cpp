#include "runners/live/devices/uri.h"

namespace remote_touch {

Uri parse_uri(const std::string& flag, const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos || colon == 0)
    throw InputError(flag + " " + text, "expected SCHEME:ADDRESS, see remote-touch devices");
  return {text.substr(0, colon), text.substr(colon + 1)};
}

}  // namespace remote_touch
