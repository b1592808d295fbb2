#include "runners/live/devices/haply_place.h"

#include <algorithm>

namespace remote_touch {

std::string HaplyPlace::authority() const {
  const bool is_ipv6 = host.find(':') != std::string::npos;
  return (is_ipv6 ? "[" + host + "]" : host) + ":" + port;
}

HaplyPlace haply_place(const DeviceAddress& address) {
  HaplyPlace place;
  std::string rest = address.place();
  if (rest.empty()) return place;
  const std::string scheme = "ws://";
  if (rest.compare(0, scheme.size(), scheme) != 0)
    throw address.refusal("is not an address of the Haply service; write ws://HOST:PORT");
  rest.erase(0, scheme.size());
  const std::size_t slash = rest.find('/');
  if (slash != std::string::npos) place.target = rest.substr(slash);
  rest.erase(std::min(slash, rest.size()));
  const std::size_t colon = rest.rfind(':');
  if (colon != std::string::npos && rest.back() != ']') {
    place.port = rest.substr(colon + 1);
    rest.erase(colon);
  }
  if (rest.size() > 2 && rest.front() == '[' && rest.back() == ']') rest = rest.substr(1, rest.size() - 2);
  if (rest.empty() || place.port.empty())
    throw address.refusal("is not an address of the Haply service; write ws://HOST:PORT");
  place.host = rest;
  return place;
}

}  // namespace remote_touch
