#include "runners/live/loop/live_view.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "runners/experiment/settings/provenance.h"
#include "runners/presentation/result_pages.h"
#include "scenarios/files/input_files.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {

namespace {

constexpr std::string_view kScheme = "http://";

bool is_port(std::string_view text) {
  return text.size() >= 2 && text.size() <= 6 && text.front() == ':' &&
         text.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

constexpr unsigned char kHand = 1, kAcknowledgement = 2, kChanges = 3, kHandRequest = 4;
constexpr std::size_t kHandSize = 64, kAcknowledgementSize = 8, kChangesHead = 8, kChangeSize = 16,
                      kHandRequestSize = 8;

template <class T>
T number_at(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

std::optional<DeviceState> hand(std::string_view bytes) {
  DeviceState pose;
  pose.buttons = number_at<std::uint32_t>(bytes, 4);
  for (int k = 0; k < 3; ++k) {
    pose.position_W[k] = number_at<double>(bytes, 8 + 8 * static_cast<std::size_t>(k));
    if (!(std::abs(pose.position_W[k]) <= kMaxHandDistance_m)) return {};
  }
  double q[4];
  for (std::size_t k = 0; k < 4; ++k) q[k] = number_at<double>(bytes, 32 + 8 * k);
  pose.orientation_W = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  const double norm = pose.orientation_W.norm();
  if (!(std::abs(norm - 1) < 0.01)) return {};
  pose.orientation_W.coeffs() /= norm;
  return pose;
}

std::optional<ParameterChanges> changes(std::string_view bytes) {
  if (bytes.size() < kChangesHead) return {};
  ParameterChanges changes;
  changes.count = number_at<std::uint32_t>(bytes, 4);
  if (changes.count == 0 || changes.count > ParameterChanges::kMax ||
      bytes.size() != kChangesHead + kChangeSize * changes.count)
    return {};
  for (std::size_t i = 0; i < changes.count; ++i) {
    const std::size_t at = kChangesHead + kChangeSize * i;
    changes.list[i] = {number_at<std::int32_t>(bytes, at), number_at<double>(bytes, at + 8)};
    if (number_at<std::uint32_t>(bytes, at + 4) != 0) return {};
  }
  return changes;
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

std::optional<PageMessage> page_message(std::string_view bytes) {
  if (bytes.size() < 4 || bytes[1] != 0 || bytes[2] != 0 || bytes[3] != 0) return {};
  const auto kind = static_cast<unsigned char>(bytes[0]);
  if (kind == kAcknowledgement && bytes.size() == kAcknowledgementSize)
    return PageAcknowledgement{number_at<std::uint32_t>(bytes, 4)};
  if (kind == kHand && bytes.size() == kHandSize)
    if (const auto pose = hand(bytes)) return *pose;
  if (kind == kChanges)
    if (const auto wanted = changes(bytes)) return *wanted;
  if (kind == kHandRequest && bytes.size() == kHandRequestSize && number_at<std::uint32_t>(bytes, 4) == 0)
    return HandRequest();
  return {};
}

LivePages::LivePages(double haptic_rate_hz, const DevicePlacement& placement, const Kernels& kernels,
                     std::shared_ptr<HandPoses> poses, std::shared_ptr<LiveControls> controls, double near_m)
    : hand_(std::make_shared<PageHand>(std::move(poses))), controls_(std::move(controls)) {
  for (Page& page : pages_)
    page.channel =
        std::make_unique<LiveChannel>(haptic_rate_hz, placement, kernels, hand_, controls_, near_m);
}

void LivePages::take(const LiveTick& tick) noexcept {
  for (Page& page : pages_) page.channel->take(tick);
}

void LivePages::take(const Frame& frame) noexcept {
  for (Page& page : pages_) page.channel->take(frame);
}

// A page that connects meanwhile receives the message once, from here or from open(): both hold the mutex.
void LivePages::tell(const LiveTrouble& trouble) {
  const std::lock_guard lock(mutex_);
  trouble_ = trouble_message(trouble);
  for (Page& page : pages_)
    if (page.channel->is_open()) page.channel->tell(trouble_);
}

void LivePages::end(const std::string& why) {
  const std::lock_guard lock(mutex_);
  if (!ended_.empty()) return;
  ended_ = why;
  for (Page& page : pages_)
    if (page.channel->is_open()) page.channel->end(ended_message(why));
}

std::string LivePages::ended() const {
  const std::lock_guard lock(mutex_);
  return ended_;
}

LivePages::Page* LivePages::with_hand() {
  const auto found =
      std::find_if(pages_.begin(), pages_.end(), [](const Page& page) { return page.channel->has_hand(); });
  return found == pages_.end() ? nullptr : &*found;
}

bool LivePages::is_full(std::string_view name) const {
  const auto others = std::count_if(pages_.begin(), pages_.end(), [&](const Page& page) {
    return page.channel->is_open() && page.name != name;
  });
  const auto is_taken = [](const Page& page) { return page.is_taken; };
  return others >= static_cast<std::ptrdiff_t>(kMax) || std::all_of(pages_.begin(), pages_.end(), is_taken);
}

LiveChannel* LivePages::open(std::string_view name) {
  if (is_full(name)) return nullptr;
  // The older connection of the same page is replaced: the page no longer uses it, even if the network has
  // not reported that yet.
  for (Page& page : pages_)
    if (page.channel->is_open() && page.name == name) {
      page.channel->close();
      page.channel->end({});
    }
  const auto page =
      std::find_if(pages_.begin(), pages_.end(), [](const Page& each) { return !each.is_taken; });
  page->name = name, page->came = ++came_;
  const PageRole role = with_hand() ? PageRole::watches : PageRole::hand;
  if (role == PageRole::hand) hand_->pass_on();
  const std::lock_guard lock(mutex_);
  page->channel->open(role, trouble_);
  page->is_taken = true;
  if (!ended_.empty()) page->channel->end(ended_message(ended_));
  return page->channel.get();
}

void LivePages::close(LiveChannel& channel) {
  channel.close();
  Page* next = nullptr;
  for (Page& page : pages_) {
    if (page.channel.get() == &channel) page.is_taken = false;
    if (page.channel->is_open() && (next == nullptr || page.came < next->came)) next = &page;
  }
  if (next != nullptr && with_hand() == nullptr) give_hand(*next->channel);
}

bool LivePages::give_hand(LiveChannel& channel) {
  if (!channel.is_open() || channel.has_hand()) return false;
  if (Page* const before = with_hand()) before->channel->set_role(PageRole::watches);
  hand_->pass_on();
  channel.set_role(PageRole::hand);
  return true;
}

bool LivePages::receive(LiveChannel& channel, std::string_view bytes) {
  if (const auto message = page_message(bytes); message && std::holds_alternative<HandRequest>(*message))
    return give_hand(channel);
  const std::vector<double> before = controls_->values();
  const bool is_message = channel.receive(bytes);
  if (controls_->values() != before)
    for (Page& page : pages_)
      if (page.channel->is_open() && page.channel.get() != &channel) page.channel->tell_parameters();
  return is_message;
}

namespace {

// Returns the name of the file, or an empty name if it cannot be written.
std::string write_redirect(const std::filesystem::path& folder, const std::string& text) {
  std::string file = (folder / "remote-touch-live-XXXXXX.html").string();
  const int descriptor = mkstemps(file.data(), 5);
  if (descriptor < 0) return {};
  const bool is_written = write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  close(descriptor);
  if (is_written) return file;
  unlink(file.c_str());
  return {};
}

constexpr const char* kPageSchema = "remote-touch-live/1";
// The points near the hand: within kNearRadii contact radii of HIP and proxy; with a tool, within kNearTool_m
// of the ball around it; without either, within kNearHand_m.
constexpr double kNearRadii = 4, kNearTool_m = 0.01, kNearHand_m = 0.02;

double length_m(const Json& renderer, const char* name) {
  return renderer.contains(name) && renderer[name].is_number() ? renderer[name].get<double>() : 0;
}

// Adds the start position of the hand. If the camera is simulated, also its pose in the first frame, and the
// meshes of the true surface.
void add_scene(Json& run, const Experiment& experiment, const LiveViewSource& source, const Kernels& kernels,
               PackedArrays& numbers) {
  const auto scenario = experiment.build_scenario(kernels);
  run["start_m"] = json_of(experiment.build_trajectory(*scenario)->at(0).position_W);
  if (source.depth != "sim:") return;  // the sensor has its own camera
  PointCloud buffer;
  const PointCloud& first = scenario->points(0)->every_point(kernels, buffer);
  if (first.image) run["sensor"] = sensor_json(first.image->X_WC);
  const std::vector<ShownMesh> meshes = shown_meshes_of_live(*scenario, experiment.settings().haptic_rate_hz);
  for (const ShownMesh& mesh : meshes) run["true_meshes"].push_back(json_of(mesh, numbers));
  run["note"] = note_on(meshes);
}

Json parameters_json(const LiveControls& controls) {
  Json list = Json::array();
  for (const LiveParameter& p : controls.parameters())
    list.push_back({{"name", p.name},
                    {"meaning", p.help},
                    {"value", p.value},
                    {"low", p.low},
                    {"high", p.high},
                    {"is_switch", p.is_switch}});
  return list;
}

LivePageFile page_of(const Experiment& experiment, const LiveViewSource& source, const LiveControls& controls,
                     const Kernels& kernels) {
  const Json configuration = parse_json(experiment.to_json(), "the experiment");
  const Json& renderer = configuration["renderer"];
  const double contact_radius_m = 0.5 * (length_m(renderer, "r1_m") + length_m(renderer, "r2_m"));
  double near_m = contact_radius_m > 0 ? kNearRadii * contact_radius_m : kNearHand_m;
  PackedArrays numbers;
  Json run{{"file", "live"},
           {"title", configuration.value("title", "")},
           {"command", source.command},
           {"device", source.device},
           {"depth", source.depth},
           {"version", version()},
           {"protocol", kViewProtocol},
           {"digest", ""},
           {"note", ""},
           {"configuration", configuration},
           {"haptic_rate_hz", experiment.settings().haptic_rate_hz},
           {"contact_radius_m", contact_radius_m},
           {"touch_radius_m", length_m(renderer, "r2_m")}};
  add_scene(run, experiment, source, kernels, numbers);
  run["parameters"] = parameters_json(controls);
  if (renderer.contains("tool_mesh")) {
    const ShownTool tool = shown_tool(renderer);
    run["tool"] = json_of(tool, numbers);
    near_m = tool.tool->reach_m + kNearTool_m;
  }
  run["near_m"] = near_m;
  const Json page{{"schema", kPageSchema}, {"runs", Json::array()}, {"live", run}};
  return {page_file(configuration.value("title", "live"), page.dump(), numbers.bytes(), false), near_m};
}

}  // namespace

RedirectPage::RedirectPage(const std::string& address, const std::vector<std::filesystem::path>& folders) {
  const std::string text =
      "<!DOCTYPE html><meta http-equiv=\"refresh\" content=\"0; url=" + address + "\">\n";
  for (const std::filesystem::path& folder : folders)
    if (file_.empty()) file_ = write_redirect(folder, text);
}

RedirectPage::~RedirectPage() {
  if (!file_.empty()) unlink(file_.c_str());
}

LiveView::LiveView(const Experiment& experiment, const LiveViewSource& source, const Kernels& kernels,
                   int port)
    : controls_(std::make_shared<LiveControls>(
          experiment, kernels,
          source.depth == "sim:" ? LiveControls::Camera::simulated : LiveControls::Camera::other)),
      page_(page_of(experiment, source, *controls_, kernels)),
      pages_(experiment.settings().haptic_rate_hz, DevicePlacement(experiment.live()), kernels, poses_,
             controls_, page_.near_m),
      server_(serve_view(std::move(page_.html), pages_, port)) {}

void LiveView::connect(LiveOptions& options) {
  options.poses = poses_;
  options.controls = controls_;
  options.on_tick = [this](const LiveTick& tick) { pages_.take(tick); };
  options.on_frame = [this](const Frame& frame) { pages_.take(frame); };
  options.on_trouble = [this](const LiveTrouble& trouble) { pages_.tell(trouble); };
}

}  // namespace remote_touch
