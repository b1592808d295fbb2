#include "runners/live/loop/live_view.h"

#include <unistd.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "runners/experiment/settings/provenance.h"
#include "runners/presentation/result_pages.h"
#include "runners/presentation/shown_run.h"
#include "scenarios/files/input_files.h"
#include "scenarios/simulated/scenario.h"

namespace remote_touch {
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
  return {page_file(configuration.value("title", "live"), page.dump(), numbers.bytes()), near_m};
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
