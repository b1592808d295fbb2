#include "runners/evaluation/figures/studies/camera_errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

namespace remote_touch::camera_errors_test {
namespace {

const Table& table_named(const Figure& figure, const std::string& name) {
  const auto found = std::find_if(figure.tables.begin(), figure.tables.end(),
                                  [&](const Table& table) { return table.name == name; });
  if (found == figure.tables.end()) throw std::out_of_range("no table " + name);
  return *found;
}
template <class Value>
const std::vector<Value>& column(const Table& table, const std::string& name) {
  const auto found = std::find_if(table.columns.begin(), table.columns.end(),
                                  [&](const Column& column) { return column.name == name; });
  if (found == table.columns.end()) throw std::out_of_range("no column " + name);
  return std::get<std::vector<Value>>(found->values);
}

// The camera sees the object 2 mm too near, or too far if side is -1. The contact point is over the measured
// surface by as many tenths of a millimetre as the setting's number from the end of the list.
TouchedObject object_with(double side) {
  TouchedObject object;
  object.table = "object", object.title = "thing", object.uncertainty_m = 0.001;
  object.captured_s = {0, 0.1};
  for (std::size_t i = 0; i < compared_renderers().size(); ++i)
    object.renderers.push_back({{}, {0.0005, side * 0.002}});
  for (std::size_t i = 0; i < depth_settings().size(); ++i) {
    const double height_m = 1e-4 * static_cast<double>(depth_settings().size() - i);
    object.settings.push_back({{}, {height_m, side * 0.002}}), object.known_frames.push_back(1);
    if (i >= spatial_count()) continue;
    DepthErrors points;
    points.to_measured_m = height_m, points.to_true_m = 0.002 - height_m;
    object.points.push_back(points);
  }
  return object;
}

Figure figure_of(const TouchedObject& object) {
  Figure figure{"name", "title", "caption"};
  add_object(figure, object, 0);
  add_comparisons(figure, {object}, 1);
  return figure;
}

TEST(BestSettings, AreJudgedByEachSurfaceForItself) {
  const Figure near = figure_of(object_with(1)), far = figure_of(object_with(-1));
  const std::string first = depth_settings()[0].name, last = depth_settings()[spatial_count() - 1].name;
  const auto best = [](const Figure& figure, const char* by) {
    return column<std::string>(table_named(figure, "best"), by).at(0);
  };
  EXPECT_EQ(best(near, "contact_by_measured"), last);
  EXPECT_EQ(best(near, "contact_by_true"), last);
  EXPECT_EQ(best(far, "contact_by_measured"), last);
  EXPECT_EQ(best(far, "contact_by_true"), first) << "a contact point above a surface seen too far is nearer";
  EXPECT_EQ(best(near, "points_by_measured"), last);
  EXPECT_EQ(best(near, "points_by_true"), first);
}

TEST(BestSettings, ChangeIfTheTruthIsMoved) {
  TouchedObject object = object_with(1);
  object.uncertainty_m = 0.004;
  const Figure figure = figure_of(object);
  const Table& best = table_named(figure, "best");
  EXPECT_EQ(column<std::string>(best, "contact_by_true_outwards").at(0), depth_settings()[0].name);
  EXPECT_EQ(column<std::string>(best, "contact_by_true_inwards").at(0),
            depth_settings()[spatial_count() - 1].name);
}

TEST(RmsOverWindows, HasTheRangeThatTheUncertaintyAllows) {
  const Figure figure = figure_of(object_with(1));
  const Table& windows = table_named(figure, "object_windows");
  EXPECT_EQ(column<double>(windows, "window").at(0), 1);
  const double total_m = 0.002 + 1e-4 * static_cast<double>(depth_settings().size());
  EXPECT_NEAR(column<double>(windows, "to_true").at(0), total_m, 1e-12);
  EXPECT_NEAR(column<double>(windows, "to_true_low").at(0), total_m - 0.001, 1e-12);
  EXPECT_NEAR(column<double>(windows, "to_true_high").at(0), total_m + 0.001, 1e-12);
}

TEST(Panels, DrawColumnsThatExist) {
  const Figure figure = figure_of(object_with(1));
  EXPECT_EQ(figure.panels.size(), compared_renderers().size() + 4);
  for (const Panel& panel : figure.panels)
    for (const Curve& curve : panel.curves)
      for (const std::string& name : {curve.x, curve.y, curve.z})
        if (!name.empty()) {
          EXPECT_NO_THROW(column<double>(table_named(figure, curve.table), name)) << name;
        }
}

TEST(RendererTable, SeparatesBothErrors) {
  const Figure figure = figure_of(object_with(-1));
  const Table& table = table_named(figure, "renderers");
  EXPECT_NEAR(column<double>(table, "renderer_rms").at(0), 0.0005, 1e-12);
  EXPECT_NEAR(column<double>(table, "camera_mean").at(0), -0.002, 1e-12);
  EXPECT_NEAR(column<double>(table, "total_rms").at(0), 0.0015, 1e-12);
  EXPECT_EQ(column<double>(table, "frames").at(0), 1);
}

}  // namespace
}  // namespace remote_touch::camera_errors_test
