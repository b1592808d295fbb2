#include "runners/sweep/sweep_streams.h"

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <nlohmann/json.hpp>

#include "core/parameters/input_error.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/sweep/sweep_reading.h"
#include "scenarios/text_files/json_text.h"

namespace remote_touch {

namespace {

using Indices = std::vector<std::size_t>;

// Returns the indices that a cell has on some of the axes.
Indices chosen(const Indices& indices, const std::vector<std::size_t>& axes) {
  Indices some;
  for (const std::size_t axis : axes) some.push_back(indices[axis]);
  return some;
}

// Returns the axes one of whose paths is as asked.
template <class IsAsked>
std::vector<std::size_t> axes_with(const std::vector<SweepAxis>& axes, IsAsked&& is_asked) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::vector<std::string> paths = axes[i].paths();
    if (std::any_of(paths.begin(), paths.end(), is_asked)) numbers.push_back(i);
  }
  return numbers;
}

// Returns the seed of the runs of a cell; `seed` where no axis sets one.
std::uint64_t seed_of(std::uint64_t seed, const std::vector<SweepAxis>& axes, const Indices& indices) {
  for (std::size_t i = 0; i < axes.size(); ++i)
    for (const auto& [path, value] : axes[i].settings[indices[i]])
      if (path == "seed") seed = value.get<std::uint64_t>();
  return seed;
}

CellStreams known_streams(const SweepResult& result, const std::string& config) {
  const std::string label = "the configuration of the sweep";
  const Json json = parse_json(config, label);
  const Json refine = json.value("refine", Json::object());
  const std::vector<SweepAxis> axes =
      read_axes(json, label, refine.is_object() ? refine.value("levels", 0) : 0);
  const Json experiment = read_experiment(json, label, {});
  const auto has_length = [](const SweepAxis& a, const Column& b) { return a.length() == b.length(); };
  if (!std::equal(axes.begin(), axes.end(), result.axes.begin(), result.axes.end(), has_length))
    throw InputError(label, "has other axes: expected those of the sweep");
  const std::vector<std::size_t> of_draws = axes_with(axes, may_change_streams);
  const std::vector<std::size_t> of_seed =
      axes_with(axes, [](const std::string& path) { return path == "seed"; });
  const std::uint64_t common_seed = Experiment::from_json(experiment).settings().key.seed;
  std::map<Indices, RandomStreams> known;
  std::map<std::uint64_t, std::size_t> seeds;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> first_cell;  // key: seed and noise cell
  CellStreams streams;
  const std::size_t cells = result.cell_count();
  streams.draws.reserve(cells), streams.noise_cell.reserve(cells), streams.seed.reserve(cells);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    Indices indices = result.axis_indices(cell);
    const auto [draws, is_new] = known.try_emplace(chosen(indices, of_draws));
    if (is_new) {
      Json own = experiment;
      for (std::size_t i = 0; i < axes.size(); ++i)
        for (const auto& [path, value] : axes[i].settings[indices[i]]) set_value(own, path, value, path);
      draws->second = random_streams(Experiment::from_json(own));
    }
    streams.draws.push_back(draws->second);
    const std::uint64_t seed = seed_of(common_seed, axes, indices);
    streams.seed.push_back(seeds.try_emplace(seed, seeds.size()).first->second);
    for (std::size_t i = 0; i < axes.size(); ++i)
      if (axes[i].common_noise) indices[i] = 0;
    std::size_t noise_cell = result.cell_at(indices);
    if (!of_seed.empty())
      noise_cell = first_cell.try_emplace({streams.seed.back(), noise_cell}, cell).first->second;
    streams.noise_cell.push_back(noise_cell);
  }
  return streams;
}

// True if the cell has several finished runs, and they are equal to the last bit in all measures.
bool has_equal_runs(const SweepResult& result, std::size_t cell) {
  std::optional<std::size_t> first;
  std::size_t done = 0;
  for (int replicate = 0; replicate < result.replicates; ++replicate) {
    const auto place = result.place_of(result.run(cell, replicate));
    if (!place || result.state[*place] != RunState::done) continue;
    ++done;
    if (!first) first = place;
    for (const Column& measure : result.measures) {
      const auto& values = std::get<std::vector<double>>(measure.values);
      if (std::bit_cast<std::uint64_t>(values[*place]) != std::bit_cast<std::uint64_t>(values[*first]))
        return false;
    }
  }
  return done > 1;
}

}  // namespace

CellStreams streams_of(const SweepResult& result, const std::string& config) {
  try {
    return known_streams(result, config);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    CellStreams careful;
    for (std::size_t cell = 0; cell < result.cell_count(); ++cell) {
      const bool is_fixed = has_equal_runs(result, cell);
      careful.draws.push_back({!is_fixed, !is_fixed});
    }
    careful.noise_cell.assign(careful.draws.size(), 0), careful.seed.assign(careful.draws.size(), 0);
    careful.doubt =
        "The configuration of the sweep does not tell which runs share random numbers: runs of one replicate "
        "count as one, and so do equal runs of a cell.";
    return careful;
  }
}

}  // namespace remote_touch
