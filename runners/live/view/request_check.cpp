#include "runners/live/view/request_check.h"

#include <array>

namespace remote_touch {

namespace {

constexpr std::string_view kScheme = "http://";

bool is_port(std::string_view text) {
  return text.size() >= 2 && text.size() <= 6 && text.front() == ':' &&
         text.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

}  // namespace

bool is_loopback_host(std::string_view host) {
  for (const std::string_view name : std::array<std::string_view, 3>{"127.0.0.1", "localhost", "[::1]"})
    if (host.starts_with(name)) {
      const std::string_view rest = host.substr(name.size());
      return rest.empty() || is_port(rest);
    }
  return false;
}

bool is_own_origin(std::string_view origin, std::string_view host) {
  return origin.starts_with(kScheme) && origin.substr(kScheme.size()) == host && is_loopback_host(host);
}

std::string refusal_text(unsigned status, const std::string& port) {
  switch (status) {
    case 403:
      return "This run can be seen only under the names 127.0.0.1 and localhost, and from its own page.\n"
             "On the machine of the run, open the address that the terminal prints. From another machine,\n"
             "type there: ssh -L 8000:127.0.0.1:" +
             port +
             " USER@MACHINE\n"
             "and open the same address with 8000 in place of " +
             port + ". Any other free port serves as well.\n";
    case 404:
      return "No run is at this address. Each run has an address of its own: open the whole address\n"
             "that the terminal prints, with the 32 letters and digits at its end.\n";
    case 409:
      return "This run is already shown by the maximum number of pages. Close one of them.\n";
    default:
      return "This request does not come from the page of a live run. Open the address that the terminal prints in a "
             "browser.\n";
  }
}

}  // namespace remote_touch
