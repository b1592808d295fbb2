#include "runners/presentation/view/view_page.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/parameters/input_error.h"
#include "runners/presentation/view/page_file.h"
#include "runners/presentation/view/viewer_files.h"

namespace remote_touch {

namespace {

constexpr const char* kPageSchema = "remote-touch-view/1";
constexpr std::size_t kMaxPointsOfFrame = 30000;
constexpr int kTrials = 8;

// Returns a first estimate of the number of points of a frame that fits. A point has six bytes of position
// and three of colour, and compression leaves about two thirds of them.
std::size_t points_of_frame(const std::vector<std::unique_ptr<ShownRun>>& runs, std::size_t max_bytes) {
  std::size_t frames = 0;
  for (const auto& run : runs) frames += run->frame_count();
  return std::min(kMaxPointsOfFrame, max_bytes / (8 * frames) + 1);
}

// Returns the number of points of a frame that may fit, after `points` made a page too large. Points that
// touch are in every page, so the size shrinks less than in proportion.
std::size_t fewer_points(std::size_t points, std::size_t bytes, std::size_t max_bytes) {
  const std::size_t fixed = std::min(max_bytes, viewer_script().size());
  const double part = static_cast<double>(max_bytes - fixed) / static_cast<double>(bytes - fixed);
  return static_cast<std::size_t>(0.8 * part * static_cast<double>(points));
}

std::string joined(const std::vector<std::unique_ptr<ShownRun>>& runs) {
  std::string text;
  for (const auto& run : runs) {
    if (runs.size() > 1) text += run->source().name + ": ";
    text += run->shown() + "\n";
    if (!run->note().empty()) text += "  " + run->note() + "\n";
  }
  return text;
}

}  // namespace

ViewPage view_page(const std::string& title, const std::vector<std::unique_ptr<ShownRun>>& runs,
                   const Json& page, const PackedArrays& numbers, const ViewOptions& options) {
  std::size_t points = points_of_frame(runs, options.max_bytes), size = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    PackedArrays all = numbers;
    Json whole{{"schema", kPageSchema}, {"runs", Json::array()}};
    whole.update(page);
    for (const auto& run : runs) whole["runs"].push_back(run->json(all, points));
    std::string html = page_file(title, whole.dump(), all.bytes());
    size = html.size();
    if (size <= options.max_bytes) return {std::move(html), joined(runs)};
    // If the first estimate was wrong, most of the page is not points, so far fewer of them fit.
    points = std::min(fewer_points(points, size, options.max_bytes), trial > 0 ? points / 3 : points);
  }
  throw InputError(runs.front()->source().name, "has a page of " + std::to_string(size) +
                                                    " bytes even with few points: expected --max-mb " +
                                                    std::to_string(size / 1'000'000 + 1) + " or more");
}

}  // namespace remote_touch
