#include "analysis/tally/cell_tally.h"

#include <algorithm>
#include <iterator>

namespace remote_touch {

namespace {

void count_note(NoteTally& note, std::int64_t runs, std::uint64_t first) {
  if (runs == 0) return;
  note.first = note.runs == 0 ? first : std::min(note.first, first);
  note.runs += runs;
}

bool is_increasing(const std::vector<std::uint64_t>& numbers) {
  return std::adjacent_find(numbers.begin(), numbers.end(), std::greater_equal<>()) == numbers.end();
}

}  // namespace

void CellTally::add_done(const TallyLayout& layout, std::uint64_t run, std::span<const double> values,
                         std::uint64_t note_bits) {
  ++done;
  for (std::size_t i = 0; i < measures.size(); ++i) measures[i].add(values[i]);
  for (std::size_t kind = 0; kind < notes.size(); ++kind) count_note(notes[kind], note_bits >> kind & 1, run);
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (!(values[layout.events[i]] > 0.5)) continue;
    events[i].insert(std::upper_bound(events[i].begin(), events[i].end(), run), run);
  }
}

void CellTally::add_failed(std::uint64_t run, const std::string& error) {
  if (failed == 0 || run < first_failed) first_failed = run, first_error = error;
  ++failed;
}

void CellTally::add(const CellTally& other) {
  done += other.done;
  if (other.failed > 0) add_failed(other.first_failed, other.first_error), failed += other.failed - 1;
  for (std::size_t i = 0; i < measures.size(); ++i) measures[i].add(other.measures[i]);
  for (std::size_t kind = 0; kind < notes.size(); ++kind)
    count_note(notes[kind], other.notes[kind].runs, other.notes[kind].first);
  for (std::size_t i = 0; i < events.size(); ++i) {
    std::vector<std::uint64_t> both;
    std::merge(events[i].begin(), events[i].end(), other.events[i].begin(), other.events[i].end(),
               std::back_inserter(both));
    events[i] = std::move(both);
  }
}

std::string CellTally::contradiction() const {
  if (done < 0 || failed < 0) return "a count is negative";
  if (failed == 0 && (first_failed != 0 || !first_error.empty()))
    return "no run failed, but there is an error";
  for (const MeasureTally& measure : measures) {
    if (measure.values + measure.unknown + measure.infinite != done)
      return "a measure has another number of runs";
    if (std::string wrong = measure.contradiction(); !wrong.empty()) return wrong;
  }
  for (const NoteTally& note : notes)
    if (note.runs < 0 || note.runs > done || (note.runs == 0 && note.first != 0))
      return "a note has a wrong number of runs";
  for (const auto& runs : events)
    if (static_cast<std::int64_t>(runs.size()) > done || !is_increasing(runs))
      return "the runs of an event are not increasing";
  return "";
}

}  // namespace remote_touch
