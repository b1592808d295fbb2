#include "runners/evaluation/figures/studies/camera_errors.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "runners/evaluation/figures/parts/figure_form.h"

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

namespace {

std::string column_of(const Toucher& renderer) {
  std::string column = renderer.name;
  std::replace(column.begin(), column.end(), ' ', '_');
  return column;
}

std::vector<double> rms_of(const TouchedObject& object, ErrorValue value, double offset_m = 0) {
  std::vector<double> values;
  for (std::size_t i = 0; i < spatial_count(); ++i)
    values.push_back(statistics_of(object.settings[i], value, offset_m).rms_m);
  return values;
}

std::vector<double> values_of(const std::vector<DepthErrors>& points, double DepthErrors::*value) {
  std::vector<double> values;
  for (const DepthErrors& errors : points) values.push_back(errors.*value);
  return values;
}

// Returns a curve's worth of errors of one renderer, one value for each frame.
std::vector<double> over_frames(const std::vector<ContactError>& errors, ErrorValue value) {
  std::vector<double> values;
  for (const ContactError& error : errors) values.push_back(value(error));
  return values;
}

Table frame_table(const TouchedObject& object) {
  Table table{object.table + "_frames", object.title + ": errors in each frame"};
  std::vector<double> frames, high_m, low_m;
  for (std::size_t i = 0; i < object.captured_s.size(); ++i) {
    frames.push_back(static_cast<double>(i));
    high_m.push_back(object.uncertainty_m), low_m.push_back(-object.uncertainty_m);
  }
  table.add("frame", "1", "frame of the recording", frames);
  table.add("time", "s", "time of capture", object.captured_s);
  table.add("truth_low", "m", "uncertainty of the truth, towards the object", low_m);
  table.add("truth_high", "m", "uncertainty of the truth, outwards", high_m);
  for (std::size_t i = 0; i < object.renderers.size(); ++i) {
    const Toucher& renderer = compared_renderers()[i];
    table.add(column_of(renderer) + "_renderer", "m",
              renderer.name + ": height of the contact point over the measured surface",
              over_frames(object.renderers[i], renderer_error_m));
    table.add(column_of(renderer) + "_camera", "m",
              renderer.name + ": height of the measured surface over the true one, at the contact point",
              over_frames(object.renderers[i], camera_error_m));
  }
  return table;
}

// Returns the smallest and the largest rms height of the contact point over the true surface if the truth is
// moved by up to its uncertainty.
std::pair<double, double> rms_range_m(const std::vector<ContactError>& errors, double uncertainty_m) {
  const double mean_m = statistics_of(errors, total_error_m).mean_m;
  const double to_mean_m = std::clamp(-mean_m, -uncertainty_m, uncertainty_m);
  return {statistics_of(errors, total_error_m, to_mean_m).rms_m,
          statistics_of(errors, total_error_m, mean_m < 0 ? -uncertainty_m : uncertainty_m).rms_m};
}

Table window_table(const TouchedObject& object) {
  const std::vector<double> measured_m = contacts_to_measured_m(object), true_m = contacts_to_true_m(object);
  TableRows rows;
  for (const std::size_t i : settings_by_window()) {
    const auto [low_m, high_m] = rms_range_m(object.settings[i], object.uncertainty_m);
    rows.push_back({depth_settings()[i].window_px, measured_m[i], true_m[i], low_m, high_m});
  }
  return table_of(object.table + "_windows", object.title + ": the proxy behind spatial filters",
                  {{"window", "1", "width of the filter, pixels; 1: no filter"},
                   {"to_measured", "m", "rms height of the contact point over the measured surface"},
                   {"to_true", "m", "rms height of the contact point over the true surface"},
                   {"to_true_low", "m", "its smallest value if the truth is moved by up to its uncertainty"},
                   {"to_true_high", "m", "its largest value then"}},
                  rows);
}

Table averages_table(const TouchedObject& object) {
  TableRows rows;
  for (std::size_t i = 0; i < depth_settings().size(); ++i)
    if (!depth_settings()[i].is_spatial())
      rows.push_back({depth_settings()[i].window_px,
                      statistics_of(object.settings[i], renderer_error_m).rms_m,
                      statistics_of(object.settings[i], total_error_m).rms_m});
  return table_of(object.table + "_averages", object.title + ": the proxy behind filters over time",
                  {{"window", "1", "width of the spatial filter, pixels; 1: no filter"},
                   {"to_measured", "m", "rms height of the contact point over the measured surface"},
                   {"to_true", "m", "rms height of the contact point over the true surface"}},
                  rows);
}

// Returns the range of an axis that holds all errors of the renderers.
std::pair<double, double> error_range(const TouchedObject& object) {
  double largest_m = object.uncertainty_m;
  for (const auto& errors : object.renderers)
    for (const ContactError& error : errors)
      for (const double value_m : {error.renderer_m, error.camera_m})
        if (std::abs(value_m) > largest_m) largest_m = std::abs(value_m);
  return {-1.1 * largest_m, 1.1 * largest_m};
}

Table renderer_table(const std::vector<TouchedObject>& objects) {
  std::vector<std::string> names, renderers;
  TableRows rows;
  for (const TouchedObject& object : objects)
    for (std::size_t i = 0; i < object.renderers.size(); ++i) {
      const std::vector<ContactError>& errors = object.renderers[i];
      const ErrorStatistics renderer = statistics_of(errors, renderer_error_m),
                            camera = statistics_of(errors, camera_error_m),
                            total = statistics_of(errors, total_error_m);
      names.push_back(object.title), renderers.push_back(compared_renderers()[i].name);
      rows.push_back({camera.frames, renderer.rms_m, renderer.mean_m, camera.rms_m, camera.mean_m,
                      total.rms_m, frame_noise_m(errors, renderer_error_m),
                      frame_noise_m(errors, camera_error_m), object.uncertainty_m});
    }
  Table table = table_of("renderers", "errors over the frames, by renderer",
                         {{"frames", "1", "frames in which both errors are known"},
                          {"renderer_rms", "m", "rms height of the contact point over the measured surface"},
                          {"renderer_mean", "m", "its mean"},
                          {"camera_rms", "m", "rms height of the measured surface over the true one"},
                          {"camera_mean", "m", "its mean"},
                          {"total_rms", "m", "rms height of the contact point over the true surface"},
                          {"renderer_noise", "m", "rms change of the renderer's error in a frame / sqrt(2)"},
                          {"camera_noise", "m", "rms change of the camera's error in a frame / sqrt(2)"},
                          {"uncertainty", "m", "uncertainty of the truth"}},
                         rows);
  table.columns.insert(table.columns.begin(), {"renderer", "1", "what touches the object", renderers, 1, {}});
  table.columns.insert(table.columns.begin(), {"object", "1", "recording and object", names, 1, {}});
  return table;
}

Table setting_table(const std::vector<TouchedObject>& objects) {
  std::vector<std::string> names, settings;
  TableRows rows;
  for (const TouchedObject& object : objects)
    for (std::size_t i = 0; i < depth_settings().size(); ++i) {
      const std::vector<ContactError>& errors = object.settings[i];
      const ErrorStatistics total = statistics_of(errors, total_error_m);
      const DepthErrors points = i < object.points.size() ? object.points[i] : DepthErrors();
      names.push_back(object.title), settings.push_back(depth_settings()[i].name);
      rows.push_back({object.known_frames[i], total.frames, statistics_of(errors, renderer_error_m).rms_m,
                      total.rms_m, frame_noise_m(errors, total_error_m), points.pixels, points.to_measured_m,
                      points.to_true_m, points.true_mean_m, points.to_true_90_m, points.normal_deg});
    }
  Table table = table_of(
      "settings", "errors of the proxy and of all points of an object, by filter",
      {{"known_frames", "1", "frames in which both errors are known"},
       {"frames", "1",
        "frames in which they are known for all filters, and over which contacts are compared"},
       {"contact_to_measured", "m", "rms height of the contact point over the measured surface"},
       {"contact_to_true", "m", "rms height of the contact point over the true surface"},
       {"contact_noise", "m", "rms change of that height in a frame / sqrt(2)"},
       {"pixels", "1", "pixels whose points are compared below"},
       {"point_to_measured", "m", "rms distance of the points to the measured surface"},
       {"point_to_true", "m", "rms distance of the points to the true surface"},
       {"point_mean", "m", "mean signed distance of the points to the true surface, positive outside"},
       {"point_to_true_90", "m", "90 % of the points are nearer to the true surface than this"},
       {"normal_angle", "deg", "median angle between the normal and the true one"}},
      rows);
  table.columns.insert(table.columns.begin(),
                       {"setting", "1", "filter of the depth images", settings, 1, {}});
  table.columns.insert(table.columns.begin(), {"object", "1", "recording and object", names, 1, {}});
  return table;
}

// Returns the best spatial setting of each object: by the measured surface, by the true one, and by the true
// one moved by its uncertainty.
Table best_table(const std::vector<TouchedObject>& objects) {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> best(6);
  const auto name = [](const std::vector<double>& values) {
    return depth_settings()[best_setting(values)].name;
  };
  for (const TouchedObject& object : objects) {
    names.push_back(object.title);
    best[0].push_back(name(contacts_to_measured_m(object)));
    best[1].push_back(name(contacts_to_true_m(object)));
    best[2].push_back(name(contacts_to_true_m(object, -object.uncertainty_m)));
    best[3].push_back(name(contacts_to_true_m(object, object.uncertainty_m)));
    best[4].push_back(name(points_to_measured_m(object)));
    best[5].push_back(name(points_to_true_m(object)));
  }
  Table table{"best", "the spatial filter with the smallest rms error"};
  table.add("object", "1", "recording and object", names);
  const ColumnName columns[] = {
      {"contact_by_measured", "1", "contact point of the proxy, by the measured surface"},
      {"contact_by_true", "1", "contact point of the proxy, by the true surface"},
      {"contact_by_true_outwards", "1", "the same if the truth is farther outwards by its uncertainty"},
      {"contact_by_true_inwards", "1", "the same if the truth is farther inwards by its uncertainty"},
      {"points_by_measured", "1", "all points of the object, by the measured surface"},
      {"points_by_true", "1", "all points of the object, by the true surface"}};
  for (std::size_t i = 0; i < best.size(); ++i)
    table.add(columns[i].name, columns[i].units, columns[i].long_name, best[i]);
  return table;
}

// Returns the errors of all points over the filter's window, for the settings of window_table().
Table point_table(const std::vector<TouchedObject>& objects) {
  Table table{"points", "all points of the objects, behind spatial filters"};
  const std::vector<std::size_t> shown = settings_by_window();
  std::vector<double> windows;
  for (const std::size_t i : shown) windows.push_back(depth_settings()[i].window_px);
  table.add("window", "1", "width of the filter, pixels; 1: no filter", windows);
  for (const TouchedObject& object : objects)
    add_columns<std::size_t>(
        table, shown,
        {{object.table + "_to_measured", "m", object.title + ": rms distance to the measured surface",
          [&](std::size_t i) { return object.points[i].to_measured_m; }},
         {object.table + "_to_true", "m", object.title + ": rms distance to the true surface",
          [&](std::size_t i) { return object.points[i].to_true_m; }},
         {object.table + "_normal", "deg", object.title + ": median angle between normal and true normal",
          [&](std::size_t i) { return object.points[i].normal_deg; }}});
  return table;
}

}  // namespace

std::vector<double> contacts_to_measured_m(const TouchedObject& object) {
  return rms_of(object, renderer_error_m);
}
std::vector<double> contacts_to_true_m(const TouchedObject& object, double offset_m) {
  return rms_of(object, total_error_m, offset_m);
}
std::vector<double> points_to_measured_m(const TouchedObject& object) {
  return values_of(object.points, &DepthErrors::to_measured_m);
}
std::vector<double> points_to_true_m(const TouchedObject& object) {
  return values_of(object.points, &DepthErrors::to_true_m);
}

void add_object(Figure& figure, const TouchedObject& object, int row) {
  figure.tables.push_back(frame_table(object));
  const std::string frames = figure.tables.back().name;
  int column = 0;
  for (const Toucher& renderer : compared_renderers()) {
    const std::string name = column_of(renderer);
    figure.panels.push_back(
        plot(object.title + ": " + renderer.name, "frame", "error (m)",
             {{frames, "frame", "truth_low", CurveStyle::band, "true surface, uncertainty", 0, "truth_high"},
              {frames, "frame", name + "_camera", CurveStyle::line, "camera: measured over true surface"},
              {frames, "frame", name + "_renderer", CurveStyle::line, "contact point over measured surface"}},
             {{{row, column}}, {}, error_range(object)}));
    ++column;
  }
  figure.tables.push_back(window_table(object));
  figure.tables.push_back(averages_table(object));
  const std::string windows = object.table + "_windows", averages = object.table + "_averages";
  figure.panels.push_back(plot(
      object.title + ": filters", "filter window (px)", "rms error of proxy (m)",
      {{windows, "window", "to_true_low", CurveStyle::band, "true surface, uncertainty", 0, "to_true_high"},
       {windows, "window", "to_true", CurveStyle::line, "to the true surface"},
       {windows, "window", "to_measured", CurveStyle::line, "to the measured surface"},
       {averages, "window", "to_true", CurveStyle::dots, "filters over time, to the true surface"},
       {averages, "window", "to_measured", CurveStyle::dots, "filters over time, to the measured surface"}},
      {{{row, column}}, {}, {}}));
}

void add_comparisons(Figure& figure, const std::vector<TouchedObject>& objects, int row) {
  figure.tables.push_back(renderer_table(objects));
  figure.tables.push_back(setting_table(objects));
  figure.tables.push_back(best_table(objects));
  figure.tables.push_back(point_table(objects));
  const auto add = [&](const char* title, int column, const char* y_label, const std::string& quantity) {
    std::vector<Curve> curves;
    for (const TouchedObject& object : objects)
      curves.push_back({"points", "window", object.table + quantity, CurveStyle::line, object.title});
    figure.panels.push_back(
        plot(title, "filter window (px)", y_label, std::move(curves), {{{row, column}}, {}, {}}));
  };
  add("All points: to the measured surface", 0, "rms distance (m)", "_to_measured");
  add("All points: to the true surface", 1, "rms distance (m)", "_to_true");
  add("Normals: to the true ones", 2, "median angle (deg)", "_normal");
}

}  // namespace remote_touch
