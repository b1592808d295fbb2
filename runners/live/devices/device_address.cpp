#include "runners/live/devices/device_address.h"

#include <algorithm>
#include <charconv>
#include <sstream>

namespace remote_touch {

Uri parse_uri(const std::string& flag, const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos || colon == 0)
    throw InputError(flag + " " + text, "expected SCHEME:ADDRESS, see remote-touch devices");
  return {text.substr(0, colon), text.substr(colon + 1)};
}

namespace {

std::string short_text(double value) {
  std::ostringstream text;
  text.exceptions(std::ios::badbit);
  text << value;
  return text.str();
}

}  // namespace

std::string list_of(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

DeviceAddress::DeviceAddress(const std::string& scheme, const std::string& address,
                             const std::vector<std::string>& known)
    : written_(scheme + ":" + address) {
  const std::size_t mark = address.find('?');
  place_ = address.substr(0, mark);
  if (mark == std::string::npos) return;
  std::istringstream settings(address.substr(mark + 1));
  settings.exceptions(std::ios::badbit);  // throws if there is no memory; otherwise it would report the end
  for (std::string setting; std::getline(settings, setting, '&');) {
    const std::size_t equals = setting.find('=');
    const std::string key = setting.substr(0, equals);
    if (std::find(known.begin(), known.end(), key) == known.end())
      throw refusal("has no setting \"" + key + "\": expected " + list_of(known));
    if (equals == std::string::npos || equals + 1 == setting.size())
      throw refusal("the setting " + key + " has no value; write " + key + "=VALUE");
    if (!settings_.emplace(key, setting.substr(equals + 1)).second)
      throw refusal("the setting " + key + " is given twice: expected once");
  }
}

// InputError adds a colon after its subject. The final colon of an address such as "haply:" is removed, so
// that the message has only one.
InputError DeviceAddress::refusal(const std::string& problem) const {
  const bool ends_with_colon = written_.back() == ':';
  return InputError(ends_with_colon ? written_.substr(0, written_.size() - 1) : written_, problem);
}

std::string DeviceAddress::word(const std::string& key, const std::string& otherwise) const {
  const auto found = settings_.find(key);
  return found == settings_.end() ? otherwise : found->second;
}

std::string DeviceAddress::choice(const std::string& key, const std::vector<std::string>& allowed) const {
  const std::string chosen = word(key, allowed.front());
  if (std::find(allowed.begin(), allowed.end(), chosen) == allowed.end())
    throw refusal(key + " is \"" + chosen + "\": expected " + list_of(allowed));
  return chosen;
}

double DeviceAddress::number(const std::string& key, double otherwise, double min, double max) const {
  if (!has(key)) return otherwise;
  const std::string text = word(key, "");
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  // The comparison is negated so that NaN is refused too.
  if (error != std::errc() || end != text.data() + text.size() || !(value >= min && value <= max))
    throw refusal(key + " is \"" + text + "\": expected a number from " + short_text(min) + " to " +
                  short_text(max));
  return value;
}

}  // namespace remote_touch
