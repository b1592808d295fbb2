#include "analysis/measures/segmentation.h"

#include <limits>
#include <stdexcept>

#include "analysis/statistics/proportion.h"

namespace remote_touch {

namespace {

double fraction(int events, int of) {
  return of > 0 ? static_cast<double>(events) / of : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

SegmentationScore& SegmentationScore::operator+=(const SegmentationScore& other) {
  found += other.found, missed += other.missed, wrong += other.wrong;
  of_class_without_depth += other.of_class_without_depth;
  return *this;
}

double SegmentationScore::recall() const {
  return fraction(found, found + missed);
}
double SegmentationScore::precision() const {
  return fraction(found, selected());
}
double SegmentationScore::depth_fraction() const {
  return fraction(found + missed, found + missed + of_class_without_depth);
}
std::pair<double, double> SegmentationScore::recall_interval() const {
  return exact_interval(found, found + missed);
}
std::pair<double, double> SegmentationScore::precision_interval() const {
  return exact_interval(found, selected());
}

SegmentationScore score_segmentation(const std::vector<char>& selected, const std::vector<char>& of_class,
                                     const std::vector<char>& has_depth) {
  if (selected.size() != of_class.size() || selected.size() != has_depth.size())
    throw std::invalid_argument("score_segmentation: columns differ in length");
  SegmentationScore score;
  for (std::size_t i = 0; i < selected.size(); ++i) {
    if (!has_depth[i])
      score.of_class_without_depth += of_class[i] ? 1 : 0;
    else if (of_class[i])
      ++(selected[i] ? score.found : score.missed);
    else if (selected[i])
      ++score.wrong;
  }
  return score;
}

}  // namespace remote_touch
