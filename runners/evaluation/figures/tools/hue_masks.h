// Pixels of an image that colour rules select, and pictures of images.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "analysis/figures/figure.h"
#include "core/dissertation/virtual_fixtures/fixture_rule.h"
#include "core/geometry/point_cloud.h"
#include "runners/experiment/catalog/experiment.h"

namespace remote_touch {

// Returns each fixture rule of an experiment separately, in order.
std::vector<std::unique_ptr<FixtureRule>> rules_of(const Experiment& experiment);

// One element a point: 1 if the rule selects the point, or if the point was measured, else 0.
std::vector<char> picked_points(const FixtureRule& rule, const PointCloud& cloud);
std::vector<char> measured_points(const PointCloud& cloud);

// Pixels of an image that a picture shows: every step'th of the columns left .. right - 1 and of the rows
// top .. bottom - 1.
struct PictureCrop {
  int left, top, right, bottom, step = 1;
};

// Returns a table with columns column, row and colour. colours: those of all pixels, 0xRRGGBB. pre: the cloud
// has an image.
Table picture_table(const std::string& name, const std::string& title, const PointCloud& cloud,
                    const std::vector<std::uint32_t>& colours, const PictureCrop& crop);
// Returns a panel that draws the table of picture_table() as an image.
Panel picture_panel(const std::string& title, int row, int column, const std::string& table,
                    const PictureCrop& crop);

}  // namespace remote_touch
