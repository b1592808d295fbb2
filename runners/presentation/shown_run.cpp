#include "runners/presentation/result_pages.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <queue>
#include <utility>

#include "analysis/storage/trace_comparison.h"
#include "analysis/trace/columns.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/changed_settings.h"

namespace remote_touch {
namespace {

constexpr std::size_t kMaxTimes = 200, kMaxMoreTimes = 600, kMaxChanges = 2000;
constexpr double kEvery_s = 1.0 / 60, kAbove_m = 1e-6, kSmallError_m = 2e-4;

// Returns NaN if the height is unknown, or if the distance to the surface is unknown because the surface has
// vanished. The distance is that of a position slightly above the surface: beyond the border of a surface it
// is unknown below.
float height_at(const Scenario& scenario, double x, double z, double time_s) {
  const double y = scenario.surface_height(x, z, scenario.truth_time_s(time_s));
  if (std::isnan(y) || std::isnan(scenario.signed_distance({x, y + kAbove_m, z}, time_s)))
    return std::numeric_limits<float>::quiet_NaN();
  return static_cast<float>(y);
}

// i, k: numbers of the node along x and z; 0.5 lies between two nodes.
float height_at_node(const Scenario& scenario, const BoundingBox& box_W, double i, double k, double time_s) {
  const Vec3 at = box_W.min() + Vec3(i, 0, k).cwiseProduct(box_W.sizes()) / (TrueHeights::kColumns - 1);
  return height_at(scenario, at.x(), at.z(), time_s);
}

std::vector<float> heights_at(const Scenario& scenario, const BoundingBox& box_W, double time_s) {
  constexpr int n = TrueHeights::kColumns;
  std::vector<float> heights;
  heights.reserve(n * n);
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i) heights.push_back(height_at_node(scenario, box_W, i, k, time_s));
  return heights;
}

// Returns the largest difference of the heights in the middle between two neighbouring nodes from the mean of
// these two, along x and along z. Heights that are unknown do not count.
double error_between_nodes_m(const Scenario& scenario, const BoundingBox& box_W,
                             std::span<const float> heights, double time_s) {
  constexpr int n = TrueHeights::kColumns;
  double largest_m = 0;
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i)
      for (const auto& [x, z] : {std::pair{1, 0}, std::pair{0, 1}}) {
        if (i + x >= n || k + z >= n) continue;
        const float mean_m = 0.5f * (heights[static_cast<std::size_t>(k * n + i)] +
                                     heights[static_cast<std::size_t>((k + z) * n + i + x)]);
        const float height_m = height_at_node(scenario, box_W, i + 0.5 * x, k + 0.5 * z, time_s);
        largest_m = std::fmax(largest_m, std::abs(height_m - mean_m));  // ignores NaN
      }
  return largest_m;
}

// Returns the largest difference of b from the mean of a and c; NaN counts as 0.
double error_between_times_m(std::span<const float> a, std::span<const float> b, std::span<const float> c) {
  double largest_m = 0;
  for (std::size_t i = 0; i < b.size(); ++i)
    largest_m = std::fmax(largest_m, std::abs(b[i] - 0.5f * (a[i] + c[i])));
  return largest_m;
}

bool same(std::span<const float> a, std::span<const float> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

// Returns the first tick and each tick at which another capture became the newest one; at most kMaxChanges.
std::vector<double> changes(const Scenario& scenario, std::span<const double> time_s) {
  std::vector<double> list = {time_s.front()};
  for (std::size_t i = 1; i < time_s.size(); ++i)
    if (scenario.truth_time_s(time_s[i]) != scenario.truth_time_s(time_s[i - 1])) list.push_back(time_s[i]);
  if (list.size() <= kMaxChanges) return list;
  std::vector<double> some;
  for (std::size_t i = 0; i < kMaxChanges; ++i) some.push_back(list[i * list.size() / kMaxChanges]);
  return some;
}

std::vector<double> even_times(double from_s, double to_s) {
  const std::size_t count =
      std::clamp<std::size_t>(static_cast<std::size_t>((to_s - from_s) / kEvery_s) + 2, 2, kMaxTimes);
  std::vector<double> list;
  for (std::size_t i = 0; i < count; ++i)
    list.push_back(from_s + (to_s - from_s) * static_cast<double>(i) / static_cast<double>(count - 1));
  return list;
}

struct HeightsAtTime {
  double time_s;
  std::vector<float> height_m;
};

// Returns the heights at some times, so that a motion which is even between them is off by kSmallError_m at
// most. The interval with the largest error is halved again and again, until there are too many times.
// error_m: receives the error that is left.
std::vector<HeightsAtTime> refined(const Scenario& scenario, const BoundingBox& box_W,
                                   const std::vector<double>& times_s, double& error_m) {
  std::vector<HeightsAtTime> list;
  const auto at = [&](double time_s) { return HeightsAtTime{time_s, heights_at(scenario, box_W, time_s)}; };
  for (const double time_s : times_s) list.push_back(at(time_s));
  struct Gap {  // two times that follow each other, and the middle between them
    double error_m;
    HeightsAtTime before, middle, after;
    bool operator<(const Gap& other) const { return error_m < other.error_m; }
  };
  std::priority_queue<Gap> gaps;
  const auto add = [&](const HeightsAtTime& before, const HeightsAtTime& after) {
    HeightsAtTime middle = at(0.5 * (before.time_s + after.time_s));
    const double error = error_between_times_m(before.height_m, middle.height_m, after.height_m);
    gaps.push({error, before, std::move(middle), after});
  };
  for (std::size_t i = 1; i < list.size(); ++i) add(list[i - 1], list[i]);
  while (!gaps.empty() && gaps.top().error_m > kSmallError_m && list.size() < kMaxMoreTimes) {
    const Gap gap = gaps.top();
    gaps.pop();
    list.push_back(gap.middle);
    add(gap.before, gap.middle), add(gap.middle, gap.after);
  }
  error_m = gaps.empty() ? 0 : gaps.top().error_m;
  std::ranges::sort(list, {}, &HeightsAtTime::time_s);
  return list;
}

std::vector<HeightsAtTime> all_changes(const Scenario& scenario, const BoundingBox& box_W,
                                       const std::vector<double>& times_s) {
  std::vector<HeightsAtTime> list;
  for (const double time_s : times_s) {
    HeightsAtTime next{time_s, heights_at(scenario, box_W, time_s)};
    if (list.empty() || !same(next.height_m, list.back().height_m)) list.push_back(std::move(next));
  }
  return list;
}

constexpr double kRoom_m = 0.03, kStatedError_m = 5e-4;
constexpr const char* kSheetIsOff =
    "The sheet of the true surface is drawn from heights at some places and times. Between them it is off by at least ";
constexpr const char* kOtherFrames =
    "These are not the frames of the run: from its configuration this program makes other frames than the program that ran it.";
constexpr const char* kOtherRadii =
    "The contact radius changes during this run: the proxy and the touching points are drawn with that of the start.";

template <class T>
std::vector<T> values(const ColumnSource& columns, const std::string& name) {
  return std::get<std::vector<T>>(columns.column(name).values);
}

std::vector<Vec3> vectors(const ColumnSource& columns, const std::string& name) {
  const auto flat = values<double>(columns, name);
  std::vector<Vec3> list;
  for (std::size_t i = 0; i + 2 < flat.size(); i += 3) list.emplace_back(flat[i], flat[i + 1], flat[i + 2]);
  return list;
}

// Returns a length among the parameters of a section, or 0 if it has none of that name.
double length_m(const Json& section, const char* name) {
  return section.contains(name) && section[name].is_number() ? section[name].get<double>() : 0;
}

// Returns the columns of numbers. Hashes are left out, because they mean nothing to a reader.
Json columns_json(const ColumnSource& columns, PackedArrays& numbers) {
  Json list = Json::array();
  for (const std::string& name : columns.column_names()) {
    const Column column = columns.column(name);
    Json entry{{"name", name},
               {"unit", column.units},
               {"meaning", column.long_name},
               {"width", column.width},
               {"names", column.value_names}};
    if (const auto* doubles = std::get_if<std::vector<double>>(&column.values))
      entry["numbers"] = numbers.add(*doubles);
    else if (const auto* integers = std::get_if<std::vector<std::int32_t>>(&column.values))
      entry["numbers"] = numbers.add(*integers);
    else
      continue;
    list.push_back(std::move(entry));
  }
  return list;
}

Json frame_json(const ShownFrame& frame, PackedArrays& numbers) {
  Json json{{"index", frame.index},
            {"captured_s", frame.captured_s},
            {"measured", frame.measured},
            {"positions", numbers.add(frame.positions)}};
  if (!frame.colours.empty()) json["colours"] = numbers.add(frame.colours);
  if (!frame.fixture_radius_m.empty()) json["fixture_radius_m"] = numbers.add(frame.fixture_radius_m);
  json["touching"] = numbers.add(frame.touching);
  json["touching_end"] = numbers.add(frame.touching_end);
  return json;
}

std::string text_of(const std::vector<ShownFrame>& frames) {
  std::size_t measured = 0, in_box = 0, shown = 0;
  bool lacks_colours = false;
  for (const ShownFrame& frame : frames) {
    measured += frame.measured, in_box += frame.in_box, shown += frame.positions.size() / 3;
    lacks_colours |= frame.lacks_colours;
  }
  const std::size_t count = std::max<std::size_t>(frames.size(), 1);
  return std::to_string(frames.size()) + (frames.size() == 1 ? " frame with " : " frames with ") +
         std::to_string(measured / count) + (frames.size() == 1 ? " points; " : " points each on average; ") +
         std::to_string(in_box / count) + " of them are around the action, " + std::to_string(shown / count) +
         " are shown" + (shown == in_box ? "" : ": all points near the proxy and some of the others") +
         (lacks_colours ? "; grey points have no known colour" : "");
}

}  // namespace

TrueHeights true_heights(const Scenario& scenario, const BoundingBox& box_W, std::span<const double> time_s) {
  TrueHeights all;
  all.stays =
      std::any_of(time_s.begin(), time_s.end(), [&](double t) { return scenario.truth_time_s(t) != t; });
  std::vector<HeightsAtTime> list =
      all.stays ? all_changes(scenario, box_W, changes(scenario, time_s))
                : refined(scenario, box_W, even_times(time_s.front(), time_s.back()), all.error_m);
  const auto is_known = [](const HeightsAtTime& at) {
    return std::ranges::any_of(at.height_m, [](float h) { return std::isfinite(h); });
  };
  if (std::ranges::none_of(list, is_known)) return {};
  const auto is_first = [&](const HeightsAtTime& at) { return same(at.height_m, list.front().height_m); };
  if (std::ranges::all_of(list, is_first)) list.resize(1);
  for (const std::size_t i : {std::size_t{0}, list.size() / 2, list.size() - 1})
    all.error_m =
        std::max(all.error_m, error_between_nodes_m(scenario, box_W, list[i].height_m, list[i].time_s));
  for (const HeightsAtTime& at : list) {
    all.time_s.push_back(at.time_s);
    all.height_m.insert(all.height_m.end(), at.height_m.begin(), at.height_m.end());
  }
  return all;
}

struct ShownRun::State {
  State(RunSource run, const Kernels& best, const std::atomic<bool>* when)
      : source(std::move(run)),
        kernels(best),
        stop(when),
        configuration(parse_json(of("config"), source.name)),
        experiment(experiment_of_run(source.attributes, source.name)),
        r2_m(length_m(configuration["renderer"], "r2_m")),
        contact_radius_m(0.5 * (length_m(configuration["renderer"], "r1_m") + r2_m)) {
    if (changes_radii()) add_note(kOtherRadii);
    add_stored_notes();
    read_path();
    if (source.columns->has("tool_orientation")) read_tool();
    find_action();
  }

  std::string of(const char* name) const { return attribute(source.attributes, name); }

  void add_note(const std::string& text) {
    if (!text.empty()) note += (note.empty() ? "" : "; ") + text;
  }
  // Adds the notes that the run stored, see RunReport.
  void add_stored_notes() {
    std::string notes;
    for (const char c : of("notes")) notes += c == '\n' ? std::string("; ") : std::string(1, c);
    add_note(notes);
  }
  bool changes_radii() const {
    const auto& changes = experiment.changes();
    return std::any_of(changes.begin(), changes.end(), [](const RendererChange& change) {
      return change.parameter == "renderer.r1_m" || change.parameter == "renderer.r2_m";
    });
  }
  void read_path() {
    path.time_s = values<double>(*source.columns, "time");
    path.proxy_W = vectors(*source.columns, "proxy_position");
    path.frame = values<std::int32_t>(*source.columns, "frame_index");
    path.touch_radius_m = r2_m;
    if (source.columns->has("frame_hash"))
      path.frame_hash = values<std::uint64_t>(*source.columns, "frame_hash");
  }
  void read_tool() {
    tool = shown_tool(configuration["renderer"]);
    path.tool = tool->tool;
    const auto flat = values<double>(*source.columns, "tool_orientation");
    for (std::size_t i = 0; i + 3 < flat.size(); i += 4)
      path.tool_orientation_W.emplace_back(flat[i], flat[i + 1], flat[i + 2], flat[i + 3]);
  }
  void find_action() {
    BoundingBox box;
    for (const char* name : {"hip_position", "slave_position"}) {
      if (!source.columns->has(name)) continue;
      for (const Vec3& p : vectors(*source.columns, name))
        if (p.allFinite()) box.extend(p);
    }
    if (path.time_s.empty() || box.isEmpty())
      throw InputError(source.name, "has no tick with a position: expected a run of one tick or more");
    box.extend(bounding_box(path.proxy_W));
    const double slave_m = configuration.contains("slave") ? length_m(configuration["slave"], "radius_m") : 0;
    const double reach_m = std::max(path.tool ? path.tool->reach_m : 0, slave_m);
    const Vec3 room = (0.15 * box.sizes()).cwiseMax(kRoom_m + reach_m);
    shown_box_W = {box.min() - room, box.max() + room};
  }

  Json description() const {
    return {{"file", std::filesystem::path(source.name).filename().string()},
            {"title", configuration.value("title", "")},
            {"command", of("command")},
            {"version", of("version")},
            {"digest", of("digest")},
            {"note", note},
            {"claims", Json::parse(source.claims)},
            {"configuration", configuration},
            {"haptic_rate_hz", experiment.settings().haptic_rate_hz},
            {"contact_radius_m", contact_radius_m}};
  }
  // Returns the name of each step of the task, such as "activate right".
  std::vector<std::string> steps() const {
    std::vector<std::string> list;
    for (const SequenceStep& step : experiment.sequence()) list.push_back(name_of(step));
    return list;
  }
  Json events() const {
    std::vector<TraceEvent> all =
        trace_events(*source.columns, steps(), held_depth_m(experiment.rendered_contact()));
    if (divergence) all.push_back(*divergence);
    std::stable_sort(all.begin(), all.end(),
                     [](const TraceEvent& a, const TraceEvent& b) { return a.tick < b.tick; });
    Json list = Json::array();
    for (const TraceEvent& event : all)
      list.push_back({{"tick", event.tick}, {"kind", event.kind}, {"text", event.text}});
    return list;
  }
  void add_frames(Json& run, PackedArrays& numbers, std::size_t wanted_others) {
    const PointScale scale = point_scale(shown_box_W);
    run["corner_m"] = json_of(scale.low_W), run["step_m"] = scale.step_m;
    run["low_m"] = json_of(Vec3(shown_box_W.min())), run["high_m"] = json_of(Vec3(shown_box_W.max()));
    if (made.frames.empty()) {
      const ShownPointsRule rule{shown_box_W, std::max(r2_m, 1.5 * contact_radius_m), wanted_others};
      made = shown_frames(experiment, path, rule, kernels, stop);
      if (!made.are_those_of_the_run) note = kOtherFrames + (note.empty() ? "" : "; " + note);
    }
    std::vector<ShownFrame> some;
    for (const ShownFrame& frame : made.frames) some.push_back(thinned(frame, wanted_others));
    Json list = Json::array();
    for (const ShownFrame& frame : some) list.push_back(frame_json(frame, numbers));
    run["frames"] = std::move(list);
    run["note"] = note;
    run["shown"] = shown = text_of(some);
    if (made.X_WC) run["sensor"] = sensor_json(*made.X_WC);
  }
  void add_truth(Json& run, PackedArrays& numbers) {
    const auto scenario = experiment.build_scenario(kernels);
    if (!meshes) {
      meshes = shown_meshes(*scenario, path.time_s);
      add_note(note_on(*meshes));
      run["note"] = note;
    }
    for (const ShownMesh& mesh : *meshes) run["true_meshes"].push_back(json_of(mesh, numbers));
    const TrueHeights heights = true_heights(*scenario, shown_box_W, path.time_s);
    if (heights.empty()) return;
    if (heights.error_m > kStatedError_m && note.find(kSheetIsOff) == std::string::npos) {
      const std::string size = formatted("%.2g mm", 1e3 * heights.error_m);
      add_note(kSheetIsOff + std::string(size));
      run["note"] = note;
    }
    run["truth"] = {{"columns", TrueHeights::kColumns},      {"stays", heights.stays},
                    {"low_m", json_of(shown_box_W.min())},   {"high_m", json_of(shown_box_W.max())},
                    {"time_s", numbers.add(heights.time_s)}, {"height_m", numbers.add(heights.height_m)}};
  }

  const RunSource source;
  const Kernels& kernels;
  const std::atomic<bool>* stop;
  const Json configuration;
  const Experiment experiment;
  const double r2_m, contact_radius_m;
  RunPath path;
  std::optional<ShownTool> tool;
  std::optional<std::vector<ShownMesh>> meshes;  // nothing before the first json()
  ShownFrames made;                              // frames with as many points as the first json() requested
  BoundingBox shown_box_W;
  std::optional<TraceEvent> divergence;
  std::string shown, note = source.note;
};

ShownRun::ShownRun(RunSource source, const Kernels& kernels, const std::atomic<bool>* stop)
    : state_(std::make_unique<State>(std::move(source), kernels, stop)) {}
ShownRun::~ShownRun() = default;

const RunSource& ShownRun::source() const {
  return state_->source;
}
std::string ShownRun::title() const {
  const std::string title = state_->configuration.value("title", "");
  return title.empty() ? state_->source.name : title;
}
const BoundingBox& ShownRun::box_W() const {
  return state_->shown_box_W;
}
void ShownRun::set_box(const BoundingBox& box_W) {
  state_->shown_box_W = box_W;
}
const std::string& ShownRun::shown() const {
  return state_->shown;
}
const std::string& ShownRun::note() const {
  return state_->note;
}

std::size_t ShownRun::frame_count() const {
  const std::vector<std::int32_t>& frame = state_->path.frame;
  std::size_t count = 0;
  for (std::size_t i = 0; i < frame.size(); ++i)
    count += frame[i] >= 0 && (i == 0 || frame[i] != frame[i - 1]) ? 1 : 0;
  return std::max<std::size_t>(count, 1);
}

void ShownRun::mark_divergence_from(const ShownRun& other) {
  const auto rate = [](const ShownRun& run) { return run.state_->experiment.settings().haptic_rate_hz; };
  if (rate(*this) != rate(other))
    throw InputError(other.source().name, "has " + Json(rate(other)).dump() + " ticks per second, but " +
                                              source().name + " has " + Json(rate(*this)).dump() +
                                              ": expected two runs with the same haptic_rate_hz");
  const TraceComparison comparison =
      compare_traces(*state_->source.columns, *other.state_->source.columns, {},
                     configuration_differences(state_->of("config"), other.state_->of("config")));
  if (comparison.divergence)
    state_->divergence = {comparison.divergence->tick, "divergence",
                          "The first difference: " + comparison.divergence->quantity + ". " +
                              comparison.divergence->explanation};
}

Json ShownRun::json(PackedArrays& numbers, std::size_t wanted_others) {
  Json run = state_->description();
  run["columns"] = columns_json(*state_->source.columns, numbers);
  run["events"] = state_->events();
  state_->add_frames(run, numbers, wanted_others);
  state_->add_truth(run, numbers);
  if (state_->tool) run["tool"] = json_of(*state_->tool, numbers);
  return run;
}

}  // namespace remote_touch
