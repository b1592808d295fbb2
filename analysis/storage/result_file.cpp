#include "analysis/storage/result_file.h"

#include <limits>
#include <sstream>

#include "analysis/storage/digest.h"
#include "analysis/trace/trace.h"

namespace remote_touch {
namespace {

std::string text(double value) {
  std::ostringstream out;
  out.exceptions(std::ios::badbit);
  out.precision(6);
  out << value;
  return out.str();
}

std::string range(double low, double high) {
  return "from " + text(low) + " to " + text(high);
}

}  // namespace

const char* verdict_name(Verdict verdict) {
  constexpr const char* kNames[] = {"pass", "fail", "open", "differs", "not run"};
  return kNames[static_cast<int>(verdict)];
}

// Comparisons are written so that NaN fails.
Claim claim_between(const std::string& figure, const std::string& claim, const std::string& paper,
                    double measured, double low, double high, const std::string& unit) {
  const bool holds = measured >= low && measured <= high;
  return {figure, claim, paper, measured, range(low, high), unit, holds ? Verdict::pass : Verdict::fail};
}

Claim claim_at_most(const std::string& figure, const std::string& claim, const std::string& paper,
                    double measured, double limit, const std::string& unit) {
  const Verdict verdict = measured <= limit ? Verdict::pass : Verdict::fail;
  return {figure, claim, paper, measured, "at most " + text(limit), unit, verdict};
}

Claim claim_at_least(const std::string& figure, const std::string& claim, const std::string& paper,
                     double measured, double limit, const std::string& unit) {
  const Verdict verdict = measured >= limit ? Verdict::pass : Verdict::fail;
  return {figure, claim, paper, measured, "at least " + text(limit), unit, verdict};
}

Claim claim_differs(const std::string& figure, const std::string& claim, const std::string& paper,
                    double measured, double low, double high, const std::string& unit) {
  Claim made = claim_between(figure, claim, paper, measured, low, high, unit);
  made.criterion = "expected here: " + made.criterion;
  if (made.verdict == Verdict::pass) made.verdict = Verdict::differs;
  return made;
}

Claim set_up(Claim check) {
  check.set_up = true;
  return check;
}

Claim claim_not_run(const std::string& figure, const std::string& claim, const std::string& reason) {
  return {figure, claim, "-", std::numeric_limits<double>::quiet_NaN(), reason, "", Verdict::not_run};
}

std::string write_trace(const std::filesystem::path& file, const std::vector<Column>& columns,
                        const TextAttributes& provenance, const std::vector<double>& step_duration_s) {
  const std::string sum = digest(columns);
  Hdf5Writer hdf5;
  hdf5.attribute("/", "schema", schema_name("trace"));
  hdf5.attributes("/", provenance);
  hdf5.attribute("/", "digest", sum);
  hdf5.attribute("/", "columns",
                 joined(names_of(columns), ","));  // the file has its datasets in another order
  hdf5.attribute("/", "default", "trace");         // NeXus: what a viewer opens first
  hdf5.group("/trace");
  hdf5.columns("/trace", columns, "time");
  hdf5.attributes("/trace", {{"NX_class", "NXdata"}, {"signal", "proxy_position"}, {"axes", "time"}});
  if (!step_duration_s.empty()) {
    hdf5.group("/timing");
    hdf5.columns("/timing", {{"step_duration", "s", "wall clock of one tick", step_duration_s}}, "");
  }
  hdf5.save(file);
  return sum;
}

namespace {

// The names in the order of the enumerations.
constexpr const char* kStyles[] = {"line", "dots", "steps", "dashed",  "circle",  "bars",     "squares",
                                   "map",  "band", "image", "surface", "letters", "intervals"};
constexpr const char* kKinds[] = {"points", "segments", "solid"};

}  // namespace

CurveStyle curve_style_named(const std::string& name) {
  const auto found = std::find(std::begin(kStyles), std::end(kStyles), name);
  if (found == std::end(kStyles)) throw std::invalid_argument("unknown style of a curve: " + name);
  return static_cast<CurveStyle>(found - std::begin(kStyles));
}

namespace {

void write_scene(Hdf5Writer& hdf5, const std::string& path, const Scene& scene) {
  const auto vector = [](const Vec3& v) { return std::vector{v.x(), v.y(), v.z()}; };
  hdf5.group(path);
  hdf5.attribute(path, "eye", vector(scene.eye));
  hdf5.attribute(path, "target", vector(scene.target));
  hdf5.attribute(path, "up", vector(scene.up));
  hdf5.attribute(path, "width", std::vector{scene.width_m});
  hdf5.attribute(path, "proportion", std::vector{scene.height_per_width});
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const ScenePart& part = scene.parts[i];
    const std::string place = path + "/part" + std::to_string(i);
    hdf5.group(place);
    hdf5.attributes(place, {{"kind", kKinds[static_cast<int>(part.kind)]},
                            {"table", part.table},
                            {"label", part.label},
                            {"triangles", part.triangles},
                            {"poses", part.poses},
                            {"coloured_by", part.coloured_by}});
    hdf5.attribute(place, "pose_row", part.pose_row);
    hdf5.attribute(place, "colour", static_cast<std::int32_t>(part.colour));
    hdf5.attribute(place, "size", std::vector{part.size_m});
    hdf5.attribute(place, "opacity", std::vector{part.opacity});
  }
}

void write_panel(Hdf5Writer& hdf5, const std::string& path, const Panel& panel) {
  const double automatic = std::numeric_limits<double>::quiet_NaN();
  const auto x = panel.x_range.value_or(std::pair(automatic, automatic));
  const auto y = panel.y_range.value_or(std::pair(automatic, automatic));
  hdf5.group(path);
  hdf5.attributes(path, {{"title", panel.title}, {"x_label", panel.x_label}, {"y_label", panel.y_label}});
  hdf5.attribute(path, "equal_aspect", panel.equal_aspect ? 1 : 0);
  hdf5.attribute(path, "x_range", std::vector{x.first, x.second});
  hdf5.attribute(path, "y_range", std::vector{y.first, y.second});
  if (panel.grid_position)
    hdf5.attribute(path, "place", std::vector{panel.grid_position->first, panel.grid_position->second});
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    const Curve& curve = panel.curves[i];
    const std::string place = path + "/curve" + std::to_string(i);
    hdf5.group(place);
    hdf5.attributes(place, {{"table", curve.table},
                            {"x", curve.x},
                            {"y", curve.y},
                            {"z", curve.z},
                            {"style", kStyles[static_cast<int>(curve.style)]},
                            {"label", curve.label}});
    hdf5.attribute(place, "radius", std::vector<double>{curve.radius});
  }
  if (panel.scene) write_scene(hdf5, path + "/scene", *panel.scene);
}

}  // namespace

std::string write_trace(const std::filesystem::path& file, const Trace& trace,
                        const TextAttributes& provenance, const std::vector<double>& step_duration_s) {
  return write_trace(file, trace.columns(), provenance, step_duration_s);
}

std::string write_figure(const std::filesystem::path& file, const Figure& figure,
                         const TextAttributes& provenance) {
  const std::string sum = digest(figure.tables);
  Hdf5Writer hdf5;
  hdf5.attribute("/", "schema", schema_name("figure"));
  hdf5.attributes("/", {{"figure", figure.name}, {"title", figure.title}, {"caption", figure.caption}});
  hdf5.attributes("/", provenance);
  hdf5.attribute("/", "digest", sum);
  hdf5.group("/tables");
  for (const Table& table : figure.tables) {
    hdf5.group("/tables/" + table.name);
    hdf5.attribute("/tables/" + table.name, "title", table.title);
    hdf5.columns("/tables/" + table.name, table.columns, "");
  }
  hdf5.group("/panels");
  for (std::size_t i = 0; i < figure.panels.size(); ++i)
    write_panel(hdf5, "/panels/" + std::to_string(i), figure.panels[i]);
  hdf5.save(file);
  return sum;
}

}  // namespace remote_touch
