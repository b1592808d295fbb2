// A live run in a browser: `remote-touch live --view`.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "runners/experiment/catalog/experiment.h"
#include "runners/live/loop/live_pages.h"
#include "runners/live/loop/live_run.h"

namespace remote_touch {

// Serves the page of a live run, and its channels, to browsers on this machine. Compiled in if Boost's
// headers are installed.
//
// The server is bound to 127.0.0.1. Its address contains a secret of 128 bits. It refuses a request without
// the secret, a request that names another host (DNS rebinding), and a request from a page of another origin,
// see live_pages.h. The refusal says what to do.
// `channel?NAME` below the address is the WebSocket of the page that calls itself NAME: lower-case
// hexadecimal digits, at most LivePages::kMaxName. `state` below the address reports why there is no channel,
// see state_message().
class ViewServer {
 public:
  virtual ~ViewServer() = default;          // calls end() and ends its thread
  virtual std::string address() const = 0;  // http://127.0.0.1:PORT/SECRET/
  // Sends the reason to the pages, see LivePages::end(). Returns when they have closed, or after a second.
  virtual void end(const std::string& why) = 0;
};

// page: HTML. port: 0 means any free port. Throws InputError if the port is not available.
std::unique_ptr<ViewServer> serve_view(std::string page, LivePages& pages, int port);

// A file that leads a browser to the page of a live run.
//
// The browser receives this file as its argument and not the address, because the arguments of all processes
// can be read, and whoever has the address can move the hand.
class RedirectPage {
 public:
  RedirectPage() = default;
  // Writes a file that only this user can read to the first of the folders that allows it.
  RedirectPage(const std::string& address, const std::vector<std::filesystem::path>& folders);
  ~RedirectPage();  // removes the file
  RedirectPage(RedirectPage&& other) noexcept { file_.swap(other.file_); }
  RedirectPage& operator=(RedirectPage&& other) noexcept {
    file_.swap(other.file_);
    return *this;
  }

  const std::string& file() const { return file_; }  // empty if none of the folders allowed it

 private:
  std::string file_;
};

// The texts about the run that the page shows.
struct LiveViewSource {
  std::string command;
  std::string device, depth;  // arguments of --device and --depth
};

// The page of a run, and the reach of the points near the hand, which it always shows.
struct LivePageFile {
  std::string html;
  double near_m = 0;
};

class LiveView {
 public:
  // port: see serve_view(). Throws InputError if the experiment's tool cannot be made or the port is not
  // available, and in a program without the viewer.
  LiveView(const Experiment& experiment, const LiveViewSource& source, const Kernels& kernels, int port);

  std::string address() const { return server_->address(); }
  // Connects the run with this view: the view gets the ticks and frames, and the run gets the hand from the
  // page. This view must outlive the run.
  void connect(LiveOptions& options);
  // Call it when the run has ended. Sends the reason to all pages, and waits at most a second until they have
  // closed. Only the first call counts. The destructor calls it too.
  void end(const std::string& why) { server_->end(why); }

 private:
  const std::shared_ptr<HandPoses> poses_ = std::make_shared<HandPoses>();
  const std::shared_ptr<LiveControls> controls_;
  LivePageFile page_;
  LivePages pages_;
  const std::unique_ptr<ViewServer> server_;
};

}  // namespace remote_touch
