// This header finds which libraries the process has loaded.
#pragma once

#include <link.h>

#include <string>

namespace remote_touch {

// Returns true if the process has loaded a library of that name, in any version: "libHD.so.3.5" has the name
// "libHD.so".
inline bool has_loaded(const std::string& name) {
  std::string beginning = "/" + name.substr(0, name.find(".so")) + ".so";
  const auto is_it = [](dl_phdr_info* one, std::size_t, void* wanted) {
    return std::string(one->dlpi_name).find(*static_cast<std::string*>(wanted)) != std::string::npos ? 1 : 0;
  };
  return dl_iterate_phdr(is_it, &beginning) != 0;
}

}  // namespace remote_touch
