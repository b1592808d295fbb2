// The address of a device as the user writes it, "haply:ws://127.0.0.1:10001?force=values&rate=2000": a
// scheme, a place and settings. choice() and number() throw InputError for a value that is not allowed.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"

namespace remote_touch {

// Names of sensors and devices: "scheme:address".
struct Uri {
  std::string scheme, address;  // the address may be empty
};

// Throws InputError if the text has no scheme or no colon. flag: "--depth" or "--device".
Uri parse_uri(const std::string& flag, const std::string& text);

// Returns the entry of that scheme. Throws InputError, which lists an example of each entry, if there is
// none.
template <class Entry>
const Entry& find_scheme(std::span<const Entry> entries, const std::string& flag, const Uri& uri) {
  std::string known;
  for (const Entry& entry : entries) {
    if (uri.scheme == entry.scheme) return entry;
    known += (known.empty() ? "" : ", ") + std::string(entry.example);
  }
  throw InputError(flag + " " + uri.scheme + ":" + uri.address, "expected " + known);
}

// Returns the words, separated by commas, for messages.
std::string list_of(const std::vector<std::string>& words);

class DeviceAddress {
 public:
  // address: without the scheme. Throws InputError if a setting is unknown, has no value or is given twice.
  DeviceAddress(const std::string& scheme, const std::string& address, const std::vector<std::string>& known);

  const std::string& place() const { return place_; }  // empty if the user gave none

  bool has(const std::string& key) const { return settings_.count(key) > 0; }
  std::string word(const std::string& key, const std::string& otherwise) const;
  // Returns the value of the setting, which must be one of `allowed`. Returns the first of them if the
  // setting is not given.
  std::string choice(const std::string& key, const std::vector<std::string>& allowed) const;
  double number(const std::string& key, double otherwise, double min, double max) const;

  InputError refusal(const std::string& problem) const;

 private:
  std::string written_, place_;
  std::map<std::string, std::string> settings_;
};

}  // namespace remote_touch
