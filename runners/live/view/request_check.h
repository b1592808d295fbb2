// Decides from the headers of a request whether the page server may answer it, and says what the user can do
// if not. The secret in the address is checked before.
#pragma once

#include <string>
#include <string_view>

namespace remote_touch {

// host: the value of the header Host. Returns true for 127.0.0.1, localhost and [::1], with any port or none:
// `ssh -L` may forward any port to the server. Another name may be one that a foreign site has pointed to
// 127.0.0.1 (DNS rebinding).
bool is_loopback_host(std::string_view host);

// origin: the value of the header Origin, which names the page that opens a WebSocket. Returns true if that
// page came from this server under the same name and port as the request. Pages of other programs on this
// machine have another port, and are refused.
bool is_own_origin(std::string_view origin, std::string_view host);

// The sentence that a browser shows instead of the page, ending with a line break. status: of HTTP; port: of
// this server.
std::string refusal_text(unsigned status, const std::string& port);

}  // namespace remote_touch
