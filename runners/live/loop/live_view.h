// A live run in a browser, `remote-touch live --view`: the messages of its pages, the channel of each, and
// all of them together.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "analysis/trace/columns.h"
#include "core/kernels/kernels.h"
#include "core/points/point_cloud.h"
#include "core/rendering/frames_and_outputs.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/live/devices/device_table.h"
#include "runners/live/devices/haptic_device.h"
#include "runners/live/loop/live_run.h"
#include "runners/live/loop/servo.h"

namespace remote_touch {

// Passes the hand of the pages to the device browser:. One page has the hand at a time, and the hand must not
// jump when another page receives it: a jump of the hand is a jump of the force. Poses are in the world
// frame, lengths in metres. The safety gate and the speed limit of BrowserDevice apply as well. Only the
// server's thread calls the functions.
class PageHand {
 public:
  explicit PageHand(std::shared_ptr<HandPoses> poses) : poses_(std::move(poses)) {}

  // A page receives the hand. BrowserDevice stops the hand in its next tick, with no button pressed. The hand
  // stays there until the page moves it.
  void pass_on();
  // A pose from the page that has the hand. The first pose after pass_on() is the reference and does not move
  // the hand. Each later pose displaces the hand, from where it was stopped, by the motion of the page since
  // the reference. So no page can make the hand jump by a wrong idea of where it is.
  void move(const DeviceState& of_page);
  // Releases the buttons, because the user can no longer do so.
  void release_buttons();

 private:
  void publish();

  const std::shared_ptr<HandPoses> poses_;
  std::optional<DeviceState> page_start_;  // the first pose of the page that has the hand
  HandMotion motion_;                      // the newest motion published
};

// The messages of a live run to its page. Numbers are little endian, and begin at multiples of eight bytes.

// One page has the hand and the sliders. All others watch; poses and changes of parameters from them are
// refused.
enum class PageRole { hand, watches };

// JSON: {"columns": [{"name", "unit", "meaning", "width", "names"}, ...]}; hashes are left out.
std::string columns_message(const std::vector<Column>& columns);

// JSON: {"values": [...], "refused": TEXT}: the present values of the live parameters. TEXT is the reason why
// the newest changes were refused; it is empty if they were made.
std::string parameters_message(const LiveControls& controls, const std::string& refused);

// JSON: {"hand": true} for the page that moves the hand and has the sliders, {"hand": false} for one that
// watches.
std::string role_message(PageRole role);

// JSON: {"trouble": {"camera": TEXT, "force": TEXT}}: what does not work now. A TEXT is empty if that part
// works.
std::string trouble_message(const LiveTrouble& trouble);

// JSON: {"ended": TEXT}: why the run has ended.
std::string ended_message(const std::string& why);

// JSON: {"alive": true}, sent when nothing else was sent for a second.
std::string alive_message();

// JSON, the answer to a request for `state`: {"protocol": NUMBER, "ended": TEXT, "full": BOOL}. protocol:
// kViewProtocol, by which a page recognises a server of another version. ended: why the run has ended; empty
// while it runs. full: the maximum number of pages is connected.
std::string state_message(const std::string& ended, bool is_full);
inline constexpr int kViewProtocol = 3;

// The region near the hand: within reach_m of the HIP or the proxy. The user feels its points and must see
// them.
struct NearHand {
  Vec3 hip_W = Vec3::Zero(), proxy_W = Vec3::Zero();
  double reach_m = 0;

  bool contains(const Vec3& p_W) const;
};

struct PointLimit {
  std::size_t max_points = 0;  // points near the hand may exceed it
  NearHand near;
};

// 1 (u32), number of the message (u32), rows (u32), 0 (u32); then all rows of each column (f64).
std::string ticks_message(const std::vector<Column>& columns, std::uint32_t number);

// 2 (u32), number of the message (u32), index of the frame (i32), points (u32), kinds of data after the
// positions (u32: 1 colours, 2 radii of forbidden regions, 3 both), measured points (u32), step in metres and
// the corner in metres (f64 x 4): a position is corner + step * number. Then positions (u16 x 3 each),
// colours (u8 x 3 each) and radii in metres (f32). If the cloud has more than limit.max_points measured
// points, only every n-th of them is sent, but all points near the hand.
std::string frame_message(const PointCloud& cloud, std::int32_t index, const PointLimit& limit,
                          std::uint32_t number);

// Returns the ticks as a page receives them: the columns of the trace, whose force and torque are those of
// the renderer. Adds `device_force` and, for a tool, `device_torque`, which were written to the device after
// the safety gate. With a slave it adds `commanded_force`, the force before the gate, which may be the
// slave's and not the renderer's. Adds `tick_interval`, by which a page counts missed deadlines, and `gate`,
// the state of the gate.
std::vector<Column> live_columns(const std::vector<LiveTick>& ticks, double haptic_rate_hz,
                                 const DevicePlacement& placement);

// Connects a live run with one page that shows it: queues the messages for the page, and handles the messages
// from the page. The run never waits for the page. A slow page receives only the newest frame, and all
// waiting ticks are dropped when there are too many.
class LiveChannel {
 public:
  static constexpr std::size_t kMaxRows = 5000;      // ticks that may wait; with more, all are dropped
  static constexpr std::size_t kMaxPoints = 300000;  // most points of a frame
  static constexpr std::uint32_t kMaxInFlight = 2;   // messages that the page has not acknowledged

  // placement: that of the device in the world. near_m: points within this distance of the HIP or the proxy,
  // m, are always sent. It grows with the contact radius when the user changes that.
  LiveChannel(double haptic_rate_hz, const DevicePlacement& placement, const Kernels& kernels,
              std::shared_ptr<PageHand> hand, std::shared_ptr<LiveControls> controls, double near_m);

  // The threads of the run call these.
  void take(const LiveTick& tick) noexcept;
  void take(const Frame& frame) noexcept;

  // open(): a page has connected, and receives everything from now on. close(): the page has disconnected.
  // The server's thread calls both. `trouble`: the newest trouble_message(); empty if there was none yet.
  void open(PageRole role = PageRole::hand, const std::string& trouble = {});
  void close();
  // Gives the hand to the page, or takes it away, and sends the page its role.
  void set_role(PageRole role);
  // Sends the parameters to the page, and why changes from it were refused. A text of parameters that still
  // waits is dropped, unless it states a refusal.
  void tell_parameters(const std::string& refused = {});
  bool is_open() const { return is_open_; }
  bool has_hand() const { return is_open_ && role_ == PageRole::hand; }
  // tell(): queues a text for the page, see the messages above. end(): queues the last text; the server
  // closes the connection after it, or at once if the text is empty. is_over(): true if the connection is to
  // be closed. Any thread may call them.
  void tell(std::string text);
  void end(std::string last);
  bool is_over();
  // Handles a message from the page. Returns false if it is malformed or if this page may not send it.
  bool receive(std::string_view bytes);
  // Stores the next message for the page in `message`. Returns false if there is none now. Texts are JSON,
  // see the messages above. The columns are sent before all other texts; only the text of end() may come
  // earlier.
  struct Message {
    std::string bytes;
    bool is_text = false;
  };
  bool next(Message& message);

 private:
  bool next_text(Message& message);
  Message tick_message();
  Message frame_message_of(const NeighbourSearch& points, std::int32_t index);
  NearHand near_hand();

  const double rate_hz_;
  const DevicePlacement placement_;
  const Kernels& kernels_;
  const std::shared_ptr<PageHand> hand_;
  const std::shared_ptr<LiveControls> controls_;
  const double near_m_;
  std::atomic<bool> is_open_ = false;
  std::mutex mutex_;
  std::vector<LiveTick> ticks_;                         // ticks since the last message
  Vec3 hip_W_ = Vec3::Zero(), proxy_W_ = Vec3::Zero();  // at the newest tick
  std::shared_ptr<const NeighbourSearch> points_;       // points of the newest frame
  std::int32_t index_ = 0;
  bool frame_is_new_ = false;
  std::vector<std::string> texts_;  // texts that wait to be sent
  std::string values_text_;         // the newest text of parameters without a refusal; may be among texts_
  std::string last_;                // last text; waits to be sent when is_ended_
  bool is_ended_ = false;
  // Members used only by the server's thread.
  PageRole role_ = PageRole::hand;
  bool sent_columns_ = false, was_frame_ = false;  // was_frame_: the last message was a frame
  std::uint32_t sent_ = 0, acknowledged_ = 0;
};

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

// The pages that show one live run. LivePages decides which page has the hand, and passes ticks, frames and
// texts to all of them.
//
// The first page has the hand; later pages watch, and may request the hand. When the page with the hand
// closes, the page that has watched longest receives the hand. A page may lose its connection and connect
// again before the server has noticed the loss. It then replaces its own older connection and keeps the hand.
// A page that connects later counts as a new page.
class LivePages {
 public:
  static constexpr std::size_t kMax = 4;  // pages at the same time

  // The same arguments as for LiveChannel.
  LivePages(double haptic_rate_hz, const DevicePlacement& placement, const Kernels& kernels,
            std::shared_ptr<HandPoses> poses, std::shared_ptr<LiveControls> controls, double near_m);

  // The threads of the run call these.
  void take(const LiveTick& tick) noexcept;
  void take(const Frame& frame) noexcept;
  void tell(const LiveTrouble& trouble);
  // The run has ended: sends the reason to every page, also to pages that connect later. Only the first call
  // counts.
  void end(const std::string& why);
  std::string ended() const;  // the reason; empty until the run has ended

  // The server's thread calls these. open() returns the channel for a page, which belongs to the page until
  // close(), or null if is_full(page). page: the name that the page gave itself, at most kMaxName bytes.
  static constexpr std::size_t kMaxName = 32;
  LiveChannel* open(std::string_view page);
  void close(LiveChannel& channel);
  // True if kMax other pages are connected, or if no channel is free. A page that connects again does not
  // count.
  bool is_full(std::string_view page) const;
  // See LiveChannel::receive(). If the message has changed parameters, the other pages receive the new
  // values. A request for the hand from a page that watches is granted, see PageHand::pass_on(); the page
  // that had the hand watches from then on.
  bool receive(LiveChannel& channel, std::string_view bytes);

 private:
  struct Page {
    std::unique_ptr<LiveChannel> channel;
    std::string name;
    bool is_taken = false;
    std::uint64_t came = 0;  // the order in which the pages came
  };
  Page* with_hand();
  bool give_hand(LiveChannel& channel);

  const std::shared_ptr<PageHand> hand_;
  const std::shared_ptr<LiveControls> controls_;
  std::array<Page, 2 * kMax> pages_;  // the older connection of each page may still be there
  std::uint64_t came_ = 0;
  mutable std::mutex mutex_;  // guards the following members
  std::string trouble_;       // the newest message; empty: none
  std::string ended_;
};

// Serves the page of a live run, and its channels, to browsers on this machine. Compiled in if Boost's
// headers are installed.
//
// The server is bound to 127.0.0.1. Its address contains a secret of 128 bits. It refuses a request without
// the secret, a request that names another host (DNS rebinding), and a request from a page of another origin,
// see is_loopback_host() and is_own_origin(). The refusal says what to do.
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
  // available.
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
