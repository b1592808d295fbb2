// Segmentation by hue of the two valves of 7.5.1 in ever more turbid water, where the truth is known.
#include <algorithm>
#include <limits>

#include "analysis/trace/image_measures.h"
#include "analysis/trace/interval_estimates.h"
#include "runners/evaluation/figures/parts/figure_context.h"
#include "runners/evaluation/figures/parts/figure_form.h"
#include "runners/evaluation/figures/parts/figure_pictures.h"
#include "scenarios/simulated/camera_scenes.h"

namespace remote_touch {

namespace {

constexpr double kLevels_per_m[] = {0, 0.3, 0.6, 1, 1.5, 2, 3};
constexpr double kDefault_per_m = 0.6;
constexpr std::size_t kShownLevels[] = {0, 2, 4};  // indices in kLevels_per_m
// Titles of the masks of these levels, which explain the colours.
constexpr const char* kMaskTitles[] = {"Picked: red and yellow", "Black: no depth, white: wrong",
                                       "Magenta: missed"};
constexpr int kFrames = 5;
constexpr int kEnoughPicked = 100;  // minimum for a meaningful precision
constexpr PictureCrop kCrop{205, 195, 435, 290};

// Colours of a drawn mask.
constexpr std::uint32_t kBack = 0x3C4654, kNoDepth = 0x000000, kMissed = 0xFF00FF, kWrong = 0xFFFFFF;
constexpr std::uint32_t kFound[] = {0xE03A30, 0xF0C020};

// The valves that the two rules of the experiment must find, and their names.
constexpr Valve kSought[] = {Valve::left, Valve::right};
constexpr const char* kNames[] = {"red", "yellow"};

struct Level {
  double turbidity_per_m = 0;
  SegmentationScore score[2];          // scores over all frames
  std::vector<std::uint32_t> picture;  // first frame: the mask against the truth
  PointCloud first;
};

std::vector<char> of_class(const std::vector<Valve>& truth, Valve valve) {
  std::vector<char> is;
  for (const Valve value : truth) is.push_back(value == valve);
  return is;
}

void draw_mask(const std::vector<char>& picked, const std::vector<char>& is, std::uint32_t found,
               std::vector<std::uint32_t>& picture) {
  for (std::size_t i = 0; i < picked.size(); ++i) {
    if (picture[i] == kNoDepth) continue;
    if (is[i]) picture[i] = picked[i] ? found : kMissed;
    if (picked[i] && !is[i]) picture[i] = kWrong;
  }
}

Level measure_level(FigureContext& context, double turbidity_per_m) {
  const Experiment experiment =
      Experiment::load("turbidity", {"scenario.turbidity_per_m=" + std::to_string(turbidity_per_m)});
  context.uses(experiment);
  const auto scenario = experiment.build_scenario(context.kernels());
  const std::vector<Valve> truth = dynamic_cast<const ValveTank&>(*scenario).truth();
  const auto rules = rules_of(experiment);
  Level level{turbidity_per_m, {}, {}, scenario->cloud(0)};
  for (int frame = 0; frame < kFrames; ++frame) {
    const PointCloud cloud = frame == 0 ? level.first : scenario->cloud(frame);
    const std::vector<char> measured = measured_points(cloud);
    if (frame == 0)
      for (const char seen : measured) level.picture.push_back(seen ? kBack : kNoDepth);
    for (std::size_t k = 0; k < 2; ++k) {
      const std::vector<char> picked = picked_points(*rules[k], cloud), is = of_class(truth, kSought[k]);
      level.score[k] += score_segmentation(picked, is, measured);
      if (frame == 0) draw_mask(picked, is, kFound[k], level.picture);
    }
  }
  return level;
}

Table score_table(const std::vector<Level>& levels, std::size_t k) {
  TableRows rows;
  for (const Level& level : levels) {
    const SegmentationScore& s = level.score[k];
    const auto [recall_low, recall_high] = s.recall_interval();
    const auto [precision_low, precision_high] = s.precision_interval();
    rows.push_back({level.turbidity_per_m, s.recall(), recall_low, recall_high, s.precision(), precision_low,
                    precision_high, s.depth_fraction(), s.found / double{kFrames}, s.missed / double{kFrames},
                    s.wrong / double{kFrames}, s.of_class_without_depth / double{kFrames}});
  }
  return table_of(kNames[k],
                  std::string("the ") + kNames[k] + " valve, " + std::to_string(kFrames) + " frames",
                  {{"turbidity", "1/m", "turbidity beta"},
                   {"recall", "1", "recall: share of its pixels with depth that are picked"},
                   {"recall_low", "1", "95 % interval, lower end"},
                   {"recall_high", "1", "95 % interval, upper end"},
                   {"precision", "1", "precision: share of the picked pixels that are its"},
                   {"precision_low", "1", "95 % interval, lower end"},
                   {"precision_high", "1", "95 % interval, upper end"},
                   {"depth_fraction", "1", "share of its pixels that have a depth"},
                   {"found", "1", "its pixels that are picked, a frame"},
                   {"missed", "1", "its pixels with depth that are not picked, a frame"},
                   {"wrong", "1", "other pixels that are picked, a frame"},
                   {"without_depth", "1", "its pixels without depth, a frame"}},
                  rows);
}

Panel fraction_panel(const std::string& title, const std::string& value, int column) {
  std::vector<Curve> curves;
  for (const char* name : kNames)
    curves.push_back({name, "turbidity", value, CurveStyle::line, name + std::string(" valve")});
  return plot(title, "turbidity (1/m)", "fraction", curves, {{{2, column}}, {{0, 3}}, {{-0.02, 1.02}}});
}

void add_pictures(Figure& figure, const std::vector<Level>& levels) {
  int column = 0;
  for (const std::size_t shown : kShownLevels) {
    const Level& level = levels[shown];
    const std::string number = std::to_string(shown);
    std::string beta = std::to_string(level.turbidity_per_m);
    beta.resize(3);
    figure.tables.push_back(picture_table("colours_" + number,
                                          "what the camera sees at " + beta + " per metre", level.first,
                                          level.first.colour, kCrop));
    figure.tables.push_back(picture_table("mask_" + number, "the masks at " + beta + " per metre",
                                          level.first, level.picture, kCrop));
    figure.panels.push_back(
        picture_panel("Seen at " + beta + " per metre", 0, column, "colours_" + number, kCrop));
    figure.panels.push_back(picture_panel(kMaskTitles[column], 1, column, "mask_" + number, kCrop));
    ++column;
  }
}

// Returns the largest rise of the fraction from one level to the next; 0 if it never rises.
double max_rise(const std::vector<Level>& levels, std::size_t k,
                double (SegmentationScore::*fraction)() const) {
  double rise = 0;
  for (std::size_t i = 1; i < levels.size(); ++i)
    rise = max_or_nan(rise, (levels[i].score[k].*fraction)() - (levels[i - 1].score[k].*fraction)());
  return rise;
}

// Returns the smallest precision over the levels with enough picked pixels; NaN if there are none.
double min_precision(const std::vector<Level>& levels, std::size_t k) {
  return min_where(
      levels.size(), [&](std::size_t i) { return levels[i].score[k].selected() >= kEnoughPicked; },
      [&](std::size_t i) { return levels[i].score[k].precision(); });
}

// Returns the lowest level at which most of the valve is missed; infinite if there is none.
double lost_at_per_m(const std::vector<Level>& levels, std::size_t k) {
  for (const Level& level : levels)
    if (level.score[k].recall() < 0.5) return level.turbidity_per_m;
  return std::numeric_limits<double>::infinity();
}

void add_claims(Figure& figure, const std::vector<Level>& levels) {
  for (std::size_t k = 0; k < 2; ++k) {
    const Claims claims(figure, std::string("the ") + kNames[k] + " valve");
    const auto at = [&](double per_m) -> const SegmentationScore& {
      return std::find_if(levels.begin(), levels.end(),
                          [&](const Level& level) { return level.turbidity_per_m == per_m; })
          ->score[k];
    };
    claims.at_least(" is found in clear water: recall", at(0).recall(), 0.99, "fraction");
    claims.at_least(" is not confused with other things in clear water: precision", at(0).precision(), 0.99,
                    "fraction");
    claims.at_least(" is found at a turbidity of 0.6 per metre: recall", at(kDefault_per_m).recall(), 0.95,
                    "fraction");
    claims.at_least(" is not confused with other things at a turbidity of 0.6 per metre: precision",
                    at(kDefault_per_m).precision(), 0.95, "fraction");
    claims.at_most(" is found less in more turbid water: largest rise of recall from a level to the next",
                   max_rise(levels, k, &SegmentationScore::recall), 0.01, "fraction");
    claims.at_most(
        " has less depth in more turbid water: largest rise of the share with depth from a level to the next",
        max_rise(levels, k, &SegmentationScore::depth_fraction), 0.01, "fraction");
    claims.at_least(
        " is not confused with other things where 100 pixels or more are picked: smallest precision",
        min_precision(levels, k), 0.95, "fraction");
    claims.at_most(" is missed at a turbidity of 3 per metre: recall", at(3).recall(), 0.05, "fraction");
  }
  Claims(figure).at_most(
      "the yellow valve is missed in water that is no more turbid than for the red one: turbidity at "
      "which most pixels are missed, yellow minus red",
      lost_at_per_m(levels, 1) - lost_at_per_m(levels, 0), 0, "1/m");
}

}  // namespace

Figure figure_turbidity(FigureContext& context) {
  std::vector<Level> levels;
  for (const double per_m : kLevels_per_m) levels.push_back(measure_level(context, per_m));
  Figure figure{
      "turbidity", "Two valves found by hue in turbid water",
      std::string(
          "A simulated camera looks at a red and a yellow valve, 900 mm away in water whose every channel "
          "is attenuated, red most of all, and veiled. First row: what it sees, cut out around the valves. "
          "Second row: what the rules of hue pick of it. Red and yellow are right, magenta is a part of a "
          "valve that is missed, white is something else that is picked, black has no depth and therefore no "
          "point. Third row: recall and precision among the pixels with depth, and the fraction of pixels "
          "with depth; the precision of 0 at the end of yellow's curve is of less than a pixel in a frame. "
          "Most of a valve is too narrow for the depth camera, which sees nothing within ") +
          std::to_string(ValveTank::Settings{}.camera.hole_px) +
          " px of an edge. The water is a model with chosen rates, so the turbidity at which a hue is lost "
          "holds for that model only. The figure shows which hue is lost first, and how."};
  for (std::size_t k = 0; k < 2; ++k) figure.tables.push_back(score_table(levels, k));
  add_pictures(figure, levels);
  figure.panels.push_back(fraction_panel("Recall", "recall", 0));
  figure.panels.push_back(fraction_panel("Precision", "precision", 1));
  figure.panels.push_back(fraction_panel("Pixels of a valve that have depth", "depth_fraction", 2));
  add_claims(figure, levels);
  return figure;
}

}  // namespace remote_touch
