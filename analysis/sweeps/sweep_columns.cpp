#include "analysis/sweeps/sweep_columns.h"

namespace remote_touch {

Column state_column(const SweepResult& result) {
  std::vector<std::int32_t> numbers;
  for (const RunState state : result.state) numbers.push_back(static_cast<std::int32_t>(state));
  return {"state",
          "1",
          "state of the run",
          std::move(numbers),
          1,
          {"not_sampled", "pending", "done", "failed", "elsewhere"}};
}

Column notes_column(const SweepResult& result) {
  return {"notes", "1", "notes on the run, one bit for each of note_kinds", result.notes};
}

std::vector<std::uint64_t> note_numbers(const Column& notes) {
  if (const auto* numbers = std::get_if<std::vector<std::uint64_t>>(&notes.values)) return *numbers;
  std::vector<std::uint64_t> numbers;
  if (const auto* narrow = std::get_if<std::vector<std::int32_t>>(&notes.values))
    for (const std::int32_t bits : *narrow)
      numbers.push_back(static_cast<std::uint64_t>(static_cast<std::int64_t>(bits)));
  return numbers;
}

Column error_column(const SweepResult& result) {
  return {"error", "1", "why the run failed", result.error};
}

Column round_column(const SweepResult& result) {
  return {"round", "1", "round of refinement that added the run; -1 if none did", result.round};
}

Column run_column(const SweepResult& result) {
  return {"run", "1", "number of the run in the whole sweep", *result.part};
}

Column replicate_column(const SweepResult& result) {
  std::vector<std::int32_t> numbers;
  for (int i = 0; i < result.replicates; ++i) numbers.push_back(i);
  return {"replicate", "1", "repetition with other noise", numbers};
}

}  // namespace remote_touch
