// The layout of this project's results in HDF5: traces and figures.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/trace/trace.h"
#include "core/points/vector.h"

namespace remote_touch {

struct Trace;

// The result of an analysis as a figure: tables, how to draw them, and claims with their verdicts.

// A 3-D picture: clouds of points, solids and line segments, as a camera would see them.

// One part of the picture, drawn from a table of the figure. Positions are the columns x, y, z.
struct ScenePart {
  // points: discs, coloured by a column colour (0xRRGGBB) and shaded by nx, ny, nz if the table has them;
  // segments: lines from x, y, z to x_end, y_end, z_end; solid: `table` has the vertices.
  enum class Kind { points, segments, solid };
  Kind kind = Kind::points;
  std::string table;
  std::uint32_t colour = 0x808080;  // used if the table has no colours
  double size_m = 0.002;            // diameter of a point
  std::string label = {};           // empty: not in the legend
  // Only for a solid. Table `triangles` has the vertex numbers of the corners in columns a, b, c. Row
  // pose_row of table `poses` has its position x, y, z and orientation qw, qx, qy, qz.
  std::string triangles = {}, poses = {};
  int pose_row = 0;
  double opacity = 1;
  // Only for points: a column of `table` that colours them in place of `colour`; a colour bar shows its
  // values.
  std::string coloured_by = {};
};

struct Scene {
  Vec3 eye = Vec3::Zero(), target = Vec3::UnitZ(), up = Vec3::UnitY();
  double width_m = 1;  // visible width at the distance of the target
  double height_per_width = 0.75;
  std::vector<ScenePart> parts = {};
};

enum class CurveStyle {
  line,
  dots,
  steps,
  dashed,
  circle,
  bars,
  squares,  // filled cells of a map; the side of a cell is the distance between samples
  map,      // filled cells like squares, coloured by z
  band,     // area between y and z
  image,    // one pixel for every cell of a grid, of colour z = 0xRRGGBB
  surface,  // heights z over a grid of (x, y), in perspective; the only curve of its panel
  letters,  // a vertical line at x, with the name of the value of z above the panel
  // A vertical bar from y to z, in the colour of the next curve of the panel. If one end is infinite or NaN,
  // an arrow points away from the other end: a limit above the largest value that was tried has z = infinity.
  intervals
};
// Returns the style of this name in files, such as "line". Throws std::invalid_argument if there is none.
CurveStyle curve_style_named(const std::string& name);

struct Curve {
  std::string table, x, y;  // names of a table and two of its columns
  CurveStyle style = CurveStyle::line;
  std::string label = {};  // empty: not in the legend
  double radius = 0;       // radius of circles, in data units
  std::string z = {};      // a third column, for maps, bands, images, surfaces, letters and intervals
};

struct Panel {
  std::string title, x_label, y_label;
  bool equal_aspect = false;
  std::vector<Curve> curves = {};
  std::optional<std::pair<double, double>> x_range = {}, y_range = {};
  std::optional<std::pair<double, double>> grid_position = {};  // row, column; absent: below the last
  std::optional<Scene> scene = {};                              // drawn instead of curves, without axes
};

// open: measured, but only on a part of the claim's range. differs: the source of the figure has another
// value than the one measured here, and the measured value is in its known range.
enum class Verdict { pass, fail, open, differs, not_run };
const char* verdict_name(Verdict verdict);  // the name in claims.json: "pass", "not run"

// The source of figures that do not name another one.
inline constexpr const char* kDissertation = "the dissertation";

// One statement of a source, or of this project, compared with a measurement. A claim that fails stays in
// the list. claim: a sentence that is understood without the other claims, a colon, and the measured
// quantity: "without noise, no lift pops through: fraction of 16 that do not".
struct Claim {
  std::string figure, claim;
  std::string paper;  // the value of the source as text; "-" if it has none
  double measured = 0;
  std::string criterion;  // text, with numbers
  std::string unit;
  Verdict verdict = Verdict::not_run;
  bool of_map = false;  // is about a whole map, so a part of the map cannot decide it
  bool set_up = false;  // checks only that the run was set up as intended; is listed apart from the claims
  std::string source = kDissertation;  // origin of `paper`: the source of its figure
};

// Passes if measured is within [low, high]. NaN fails.
Claim claim_between(const std::string& figure, const std::string& claim, const std::string& paper,
                    double measured, double low, double high, const std::string& unit);
// Pass if measured is at most, or at least, the limit. NaN fails.
Claim claim_at_most(const std::string& figure, const std::string& claim, const std::string& paper,
                    double measured, double limit, const std::string& unit);
Claim claim_at_least(const std::string& figure, const std::string& claim, const std::string& paper,
                     double measured, double limit, const std::string& unit);
// The source has another value than the one measured. The verdict is `differs` if measured is within [low,
// high], its known range in this program, else `fail`.
Claim claim_differs(const std::string& figure, const std::string& claim, const std::string& paper,
                    double measured, double low, double high, const std::string& unit);
// Marks the claim as a check that the run was set up as intended.
Claim set_up(Claim check);
Claim claim_not_run(const std::string& figure, const std::string& claim, const std::string& reason);

struct Figure {
  std::string name, title, caption;
  std::vector<Table> tables = {};
  std::vector<Panel> panels = {};
  std::vector<Claim> claims = {};
  std::string source = kDissertation;  // reference of the figure, with its article
};

// Writes the columns, those of Trace::columns(), and returns their digest. provenance: config, command,
// version and so on, stored as root attributes. It adds the attributes schema, digest, default and columns
// (their names in the order of the digest). step_duration_s: wall clock time of each tick, stored outside the
// digest as /timing; empty: not stored.
std::string write_trace(const std::filesystem::path& file, const std::vector<Column>& columns,
                        const TextAttributes& provenance, const std::vector<double>& step_duration_s);
std::string write_trace(const std::filesystem::path& file, const Trace& trace,
                        const TextAttributes& provenance, const std::vector<double>& step_duration_s);

std::string write_figure(const std::filesystem::path& file, const Figure& figure,
                         const TextAttributes& provenance);

}  // namespace remote_touch
