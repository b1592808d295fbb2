// Names of sensors and devices: "scheme:address".
#pragma once

#include <span>
#include <string>

#include "core/parameters/input_error.h"

namespace remote_touch {

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

}  // namespace remote_touch
