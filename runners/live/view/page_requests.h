// A page of a live run sends requests, which are checked, and messages, which are not trusted.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "runners/live/devices/browser_device.h"
#include "runners/live/loop/live_controls.h"

namespace remote_touch {

// Decides from the headers of a request whether the page server may answer it, and says what the user can do
// if not. The secret in the address is checked before.

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

// The messages of a page that shows a live run. They are not trusted: any program on this machine may have
// sent them.

// The page has shown the message of that number, and all before it.
struct PageAcknowledgement {
  std::uint32_t number = 0;
};

// The user of the page asks for the hand and the sliders of another page.
struct HandRequest {};

using PageMessage = std::variant<DeviceState, PageAcknowledgement, ParameterChanges, HandRequest>;

inline constexpr std::size_t kMaxPageMessage = 8 + 16 * ParameterChanges::kMax;  // bytes

// Decodes a message; all numbers are little endian.
// - A hand: 1, three bytes 0, buttons (u32), position in metres and quaternion w x y z (f64); 64 bytes.
// - An acknowledgement: 2, three bytes 0, number (u32); 8 bytes.
// - Changes of parameters: 3, three bytes 0, their count (u32); then for each change its parameter (i32),
//   0 (u32) and value (f64).
// - A request for the hand: 4, three bytes 0, 0 (u32); 8 bytes.
// Returns none for anything else, and for a pose that is not finite or too far away, or whose quaternion is
// not approximately a unit quaternion.
std::optional<PageMessage> page_message(std::string_view bytes);

}  // namespace remote_touch
