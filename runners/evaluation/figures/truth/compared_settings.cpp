#include "runners/evaluation/figures/truth/compared_settings.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace remote_touch {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kProxyRest_m = 0.005, kBall_m = 0.01;  // r_c of Table 4.2; radius of the tool `ball`
constexpr const char* kProxyRenderer = R"({"name": "proxy"})";

Json pipeline_json(const DepthSetting& setting) {
  return {{"filter_window", static_cast<int>(setting.window_px)}, {"sigma_f_m", setting.sigma_f_m}};
}

}  // namespace

const std::vector<Toucher>& compared_renderers() {
  static const std::vector<Toucher> list = {
      {"proxy", kProxyRenderer, "", kProxyRest_m},
      {"tracked sheet", R"({"name": "tracked-sheet"})", "", kProxyRest_m},
      {"ball as tool", R"({"name": "tool", "tool_mesh": "ball"})", "{}", kBall_m}};
  return list;
}

const std::vector<DepthSetting>& depth_settings() {
  const DepthPipelineSettings standard;
  static const std::vector<DepthSetting> list = {
      {"no filter", 1, kNoValue, ""},
      {"3 x 3 pixels", 3, standard.sigma_f_m, ""},
      {"5 x 5 pixels", 5, standard.sigma_f_m, ""},
      {"9 x 9 pixels, the default", static_cast<double>(standard.filter_window), standard.sigma_f_m, ""},
      {"15 x 15 pixels", 15, standard.sigma_f_m, ""},
      {"9 x 9 pixels, sigma_f = 5 mm", 9, 0.005, ""},
      {"filter over time", 1, kNoValue, "exponential"},
      {"mean of four frames", 1, kNoValue, "mean"}};
  return list;
}

Toucher toucher_of(const DepthSetting& setting) {
  if (!setting.is_spatial()) {
    const Json renderer = {{"name", "averaged-proxy"}, {"average", setting.average}};
    return {setting.name, renderer.dump(), "", kProxyRest_m};
  }
  if (setting.window_px == 1) return {setting.name, kProxyRenderer, "", kProxyRest_m};
  Json pipeline = pipeline_json(setting);
  pipeline["normal_window"] = 3, pipeline["normal_fit"] = "inverse-depth";
  return {setting.name, kProxyRenderer, pipeline.dump(), kProxyRest_m};
}

std::optional<DepthPipelineSettings> pipeline_of(const DepthSetting& setting) {
  if (!setting.is_spatial()) return {};
  DepthPipelineSettings settings;
  settings.filter = setting.window_px > 1;
  if (settings.filter)
    settings.filter_window = static_cast<int>(setting.window_px), settings.sigma_f_m = setting.sigma_f_m;
  return settings;
}

std::size_t best_setting(const std::vector<double>& values) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] < values[best] || std::isnan(values[best])) best = i;
  return best;
}

std::size_t spatial_count() {
  return static_cast<std::size_t>(
      std::count_if(depth_settings().begin(), depth_settings().end(),
                    [](const DepthSetting& setting) { return setting.is_spatial(); }));
}

std::size_t default_setting() {
  const DepthPipelineSettings standard;
  const auto found =
      std::find_if(depth_settings().begin(), depth_settings().end(), [&](const DepthSetting& setting) {
        return setting.window_px == standard.filter_window && setting.sigma_f_m == standard.sigma_f_m;
      });
  return static_cast<std::size_t>(found - depth_settings().begin());
}

std::vector<std::size_t> settings_by_window() {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < spatial_count(); ++i) {
    const DepthSetting& setting = depth_settings()[i];
    if (setting.window_px == 1 || setting.sigma_f_m == DepthPipelineSettings().sigma_f_m) chosen.push_back(i);
  }
  return chosen;
}

}  // namespace remote_touch
