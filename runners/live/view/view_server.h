// Serves the page of a live run, and its channel, to a browser on this machine. Compiled in if Boost's
// headers are installed.
//
// Bound to 127.0.0.1. The address has a secret of 128 bits; a request without it, with the name of another
// host (DNS rebinding), or from a page of another origin is refused. One page at a time has the channel.
#pragma once

#include <memory>
#include <string>

#include "runners/live/view/live_channel.h"

namespace remote_touch {

bool view_server_is_compiled_in();

class ViewServer {
 public:
  virtual ~ViewServer() = default;          // ends its thread
  virtual std::string address() const = 0;  // http://127.0.0.1:PORT/SECRET/
};

// page: HTML. port: 0 is any that is free. Throws InputError when the port cannot be had.
std::unique_ptr<ViewServer> serve_view(std::string page, LiveChannel& channel, int port);

}  // namespace remote_touch
