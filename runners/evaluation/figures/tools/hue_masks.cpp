#include "runners/evaluation/figures/tools/hue_masks.h"
#include "runners/evaluation/figures/tools/figure_form.h"

#include <nlohmann/json.hpp>

#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

std::vector<std::unique_ptr<FixtureRule>> rules_of(const Experiment& experiment) {
  std::vector<std::unique_ptr<FixtureRule>> rules;
  const Json resolved = parse_json(experiment.to_json(), "experiment");
  for (const Json& part : resolved.at("fixtures")) {
    const auto factory = find_entry(fixtures(), part.at("name").get<std::string>(), "fixture").make();
    read_parameters(part, factory->settings(), "fixtures", {"name"});
    rules.push_back(factory->build());
  }
  return rules;
}

std::vector<char> picked_points(const FixtureRule& rule, const PointCloud& cloud) {
  std::vector<char> picked;
  for (const double fraction : rule.weights(cloud)) picked.push_back(fraction > 0);
  return picked;
}

std::vector<char> measured_points(const PointCloud& cloud) {
  std::vector<char> measured;
  for (std::size_t i = 0; i < cloud.size(); ++i) measured.push_back(cloud.is_measured(i));
  return measured;
}

Table picture_table(const std::string& name, const std::string& title, const PointCloud& cloud,
                    const std::vector<std::uint32_t>& colours, const PictureCrop& crop) {
  const int width = cloud.image->camera.width;
  TableRows rows;
  for (int v = crop.top; v < crop.bottom; v += crop.step)
    for (int u = crop.left; u < crop.right; u += crop.step)
      rows.push_back({double(u), double(v), double(colours[static_cast<std::size_t>(v) * width + u])});
  return table_of(name, title,
                  {{"column", "px", "column of the pixel"},
                   {"row", "px", "row of the pixel"},
                   {"colour", "1", "red * 65536 + green * 256 + blue"}},
                  rows);
}

Panel picture_panel(const std::string& title, int row, int column, const std::string& table,
                    const PictureCrop& crop) {
  // Rows count downwards.
  return plot(
      title, "", "", {{table, "column", "row", CurveStyle::image, "", 0, "colour"}},
      {{{row, column}}, {{crop.left - 0.5, crop.right - 0.5}}, {{crop.bottom - 0.5, crop.top - 0.5}}, true});
}

}  // namespace remote_touch
