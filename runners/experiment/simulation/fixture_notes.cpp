#include "runners/experiment/simulation/fixture_notes.h"

#include <algorithm>
#include <iterator>
#include <string>

#include "core/search/neighbour_search.h"

namespace remote_touch {

std::vector<Note> fixture_notes(const FixtureAssignment& fixtures,
                                const std::shared_ptr<const NeighbourSearch>& first,
                                const std::shared_ptr<const NeighbourSearch>& last) {
  const auto* const at_first = dynamic_cast<const CloudSearch*>(first.get());
  const auto* const at_last = dynamic_cast<const CloudSearch*>(last.get());
  if (fixtures.empty() || !at_first || !at_last) return {};
  std::vector<std::size_t> rules = fixtures.rules_without_points(at_first->cloud());
  if (!rules.empty() && at_last != at_first) {
    std::vector<std::size_t> in_both;
    const std::vector<std::size_t> later = fixtures.rules_without_points(at_last->cloud());
    std::set_intersection(rules.begin(), rules.end(), later.begin(), later.end(),
                          std::back_inserter(in_both));
    rules = std::move(in_both);
  }
  std::vector<Note> notes;
  for (const std::size_t rule : rules)
    notes.push_back({"nothing selected", "fixtures." + std::to_string(rule) +
                                             " selects no point of the first frame and none of the last"});
  return notes;
}

}  // namespace remote_touch
