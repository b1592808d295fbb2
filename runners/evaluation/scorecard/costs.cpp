#include "runners/evaluation/scorecard/costs.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "analysis/statistics/means_and_extremes.h"
#include "analysis/storage/atomic_file.h"
#include "analysis/trace/trace.h"
#include "runners/evaluation/scorecard/json_number.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/simulation/simulation.h"

namespace remote_touch {

Cost measured_cost(const BenchmarkSweep& sweep, const std::string& scene, const std::string& method,
                   const Kernels& kernels, const std::atomic<bool>* stop) {
  const std::size_t cell = std::min(kCostLevel, sweep.sweep.plan().cell_count() - 1);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Cost best{scene, method, kNone, kNone};
  try {
    for (int round = 0; round < 2; ++round) {
      std::vector<double> ticks, frames;
      SimulationOptions options;
      options.kernels = &kernels, options.stop = stop, options.generate_all_points = true;
      options.step_duration_s = &ticks, options.frame_duration_s = &frames;
      simulate(sweep.sweep.experiment(cell, 0), options);
      if (!(mean(ticks) >= best.tick_s)) best.tick_s = mean(ticks), best.frame_s = mean(frames);
    }
  } catch (const std::exception&) {
    return {scene, method, kNone, kNone};  // the sweep's file contains the error
  }
  return best;
}

TextAttributes cost_origin(const Kernels& kernels) {
  TextAttributes origin = provenance("", "", kernels.isa);
  std::erase_if(origin, [](const auto& one) { return one.first == "config" || one.first == "command"; });
  origin.emplace_back("cpu", cpu_name());
  return origin;
}

void write_costs(const std::filesystem::path& file, const std::vector<Cost>& costs,
                 const TextAttributes& origin) {
  Json list = Json::array();
  for (const Cost& cost : costs)
    list.push_back({{"scene", cost.scene},
                    {"method", cost.method},
                    {"tick_s", number_or_null(cost.tick_s)},
                    {"frame_s", number_or_null(cost.frame_s)}});
  Json all = Json::object();
  for (const auto& [name, value] : origin) all[name] = value;
  all["costs"] = list;
  const std::string text = all.dump(1) + "\n";
  write_file_atomically(file, text.data(), text.size());
}

std::vector<Cost> read_costs(const std::filesystem::path& file, const TextAttributes& origin) {
  const Json all = json_in_file(file);
  std::vector<Cost> costs;
  if (!all.is_object() || !all.contains("costs") || !all["costs"].is_array()) return costs;
  for (const char* name : {"source_digest", "isa", "cpu"})
    if (all.value(name, Json()) != attribute(origin, name)) return costs;
  const Json& list = all["costs"];
  const auto seconds = [](const Json& value) {
    return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
  };
  for (const Json& item : list) {
    if (!item.is_object() || !item.value("scene", Json()).is_string() ||
        !item.value("method", Json()).is_string())
      return {};
    const double tick_s = seconds(item.value("tick_s", Json()));
    if (std::isnan(tick_s)) continue;  // the run ended with an error: it is measured again
    costs.push_back({item["scene"].get<std::string>(), item["method"].get<std::string>(), tick_s,
                     seconds(item.value("frame_s", Json()))});
  }
  return costs;
}

const Cost* find_cost(const std::vector<Cost>& costs, const std::string& scene, const std::string& method) {
  for (const Cost& cost : costs)
    if (cost.scene == scene && cost.method == method) return &cost;
  return nullptr;
}

}  // namespace remote_touch
