// The address of a device as the user writes it, "haply:ws://127.0.0.1:10001?force=values&rate=2000": a
// scheme, a place and settings. choice() and number() throw InputError for a value that is not allowed.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/parameters/input_error.h"

namespace remote_touch {

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
