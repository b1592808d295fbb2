// Serves the page of a live run, and its channels, to browsers on this machine. Compiled in if Boost's
// headers are installed.
//
// The server is bound to 127.0.0.1. Its address contains a secret of 128 bits. It refuses a request without
// the secret, a request that names another host (DNS rebinding), and a request from a page of another origin,
// see live_pages.h. The refusal says what to do.
// `channel?NAME` below the address is the WebSocket of the page that calls itself NAME: lower-case
// hexadecimal digits, at most LivePages::kMaxName. `state` below the address reports why there is no channel,
// see state_message().
#pragma once

#include <memory>
#include <string>

#include "runners/live/view/live_pages.h"

namespace remote_touch {

class ViewServer {
 public:
  virtual ~ViewServer() = default;          // calls end() and ends its thread
  virtual std::string address() const = 0;  // http://127.0.0.1:PORT/SECRET/
  // Sends the reason to the pages, see LivePages::end(). Returns when they have closed, or after a second.
  virtual void end(const std::string& why) = 0;
};

// page: HTML. port: 0 means any free port. Throws InputError if the port is not available.
std::unique_ptr<ViewServer> serve_view(std::string page, LivePages& pages, int port);

}  // namespace remote_touch
