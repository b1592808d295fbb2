#include "runners/experiment/hand/trajectory.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {

using Settings = ContactReplay::Settings;

namespace {

constexpr double kMaxCoordinateInFile_m = 100;

const std::vector<ColumnQuantity>& quantities() {
  using Unit = ColumnQuantity::Unit;
  static const std::vector<ColumnQuantity> all = {{{"time", "t"}, Unit::time}, {{"x", "px"}, Unit::length},
                                                  {{"y", "py"}, Unit::length}, {{"z", "pz"}, Unit::length},
                                                  {{"fx"}, Unit::force},       {{"fy"}, Unit::force},
                                                  {{"fz"}, Unit::force}};
  return all;
}

NumberColumns columns_named(const std::string& where, const std::vector<std::string_view>& names) {
  NumberColumns columns(where, {names.begin(), names.end()}, quantities());
  for (std::size_t i = 0; i < quantities().size(); ++i)
    if (!columns.has(i))
      refuse(where, "no column ", std::string(quantities()[i].names.front()),
             ": expected time, x, y, z, fx, fy and fz, each with its unit (_s, _ms, _m, _mm, _N) or without");
  return columns;
}

std::string_view trimmed(std::string_view text) {
  constexpr const char* kBlanks = " \t\v\f\r";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

std::vector<std::string_view> fields_of_line(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0;;) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    fields.push_back(trimmed(line.substr(begin, end - begin)));
    if (end == line.size()) return fields;
    begin = end + 1;
  }
}

ForceTraceRow row_of(const std::string& where, const std::vector<std::string_view>& fields,
                     const NumberColumns& columns) {
  std::array<double, 7> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = columns.value(where, fields, i);
    if (!std::isfinite(values[i])) columns.refuse_number(where, fields, i);
  }
  return {values[0], {values[1], values[2], values[3]}, {values[4], values[5], values[6]}};
}

class TraceReader {
 public:
  TraceReader(const std::filesystem::path& file, const std::string& traj_columns)
      : file_(file), is_csv_(has_ending(file, ".csv")) {
    if (!is_csv_) columns_ = columns_named("trajectory.columns", words_of_line(traj_columns));
    has_columns_ = !is_csv_;
  }

  void add(std::size_t number, std::string_view line) {
    const std::string where = file_.string() + ":" + std::to_string(number);
    const std::vector<std::string_view> fields = is_csv_ ? fields_of_line(line) : words_of_line(line);
    if (!has_columns_) {
      columns_ = columns_named(where, fields);
      has_columns_ = true;
      return;
    }
    check_count(where, fields.size());
    const ForceTraceRow row = row_of(where, fields, columns_);
    if (!trace_.rows.empty() && !(row.time_s > trace_.rows.back().time_s))
      refuse(where, "time ", row.time_s, " s: expected above that of the row before, ",
             trace_.rows.back().time_s, " s");
    if (row.contact_m.cwiseAbs().maxCoeff() > kMaxCoordinateInFile_m)
      refuse(where,
             "a position more than 100 m from the origin: expected metres, or columns x_mm, y_mm, z_mm");
    trace_.rows.push_back(row);
  }

  ForceTrace take() {
    if (trace_.rows.size() < 2)
      refuse(file_.string(), "has ", trace_.rows.size(), " row(s): expected 2 or more");
    trace_.unused = columns_.unused();
    trace_.states_length = columns_.states_unit(1);
    for (std::size_t i = columns_.count(); i < most_fields_; ++i)
      trace_.unused.push_back("column " + std::to_string(i + 1));
    return std::move(trace_);
  }

 private:
  void check_count(const std::string& where, std::size_t fields) {
    const std::size_t expected = columns_.count();
    if (fields < expected || (is_csv_ && fields > expected))
      refuse(where, fields, " values: expected ", expected, is_csv_ ? "" : " or more");
    most_fields_ = std::max(most_fields_, fields);
  }

  const std::filesystem::path file_;
  const bool is_csv_;
  bool has_columns_ = false;
  NumberColumns columns_;
  ForceTrace trace_;
  std::size_t most_fields_ = 0;
};

using Row = ContactReplay::Row;

constexpr double kRows_per_s = 1000;     // rows of a generated contact; the usual haptic rate
constexpr double kMaxDuration_s = 1000;  // longest generated contact
// Longest contact of a file. Times of this size in a file are often milliseconds.
constexpr double kMaxFileDuration_s = 1e4;
constexpr double kFullTurn_rad = 6.283185307179586;

const char* const kReplaySubject = "trajectory.name = contact-replay";

// A contact at a moment. outward: the unit normal of the surface.
struct Contact {
  double time_s = 0;
  Vec3 position_W = Vec3::Zero(), outward_W = Vec3::Zero();
  double gap_m = 0;  // distance from contact in free motion
  Vec3 force_N = Vec3::Zero();
};

Row row_of(const Contact& contact, const Settings& s) {
  return {contact.time_s,
          contact.position_W + (s.onset_distance_m + contact.gap_m) * contact.outward_W -
              contact.force_N / s.stiffness_N_per_m,
          contact.force_N};
}

// The times at which the parts of a generated contact end.
struct Timing {
  explicit Timing(const Settings& s)
      : approach_s(s.clearance_m / s.speed_m_per_s),
        load_s(approach_s + s.ramp_s),
        slide_s(load_s + (s.to_m - s.from_m).norm() / s.speed_m_per_s),
        unload_s(slide_s + s.ramp_s),
        retreat_s(unload_s + s.clearance_m / s.speed_m_per_s) {}
  double approach_s, load_s, slide_s, unload_s, retreat_s;
};

// --- a contact from a file ---

// Sets the outward normals: that of the true surface if it is known, else the direction of the force, else
// that of the contact before, or of the first one after that has a direction. Throws InputError if no contact
// has a force.
void add_normals(const std::string& file, const Scenario& scenario, std::vector<Contact>& contacts) {
  const auto touches = [](const Contact& contact) { return !contact.force_N.isZero(0); };
  const auto first = std::find_if(contacts.begin(), contacts.end(), touches);
  if (first == contacts.end())
    refuse(file, "has no force above trajectory.contact_force_N: expected the forces of a contact");
  Vec3 last_W = first->force_N.normalized();
  for (Contact& contact : contacts) {
    const Vec3 true_normal_W = scenario.true_normal(contact.position_W, contact.time_s);
    if (true_normal_W.allFinite())
      last_W = true_normal_W;
    else if (touches(contact))
      last_W = contact.force_N.normalized();
    contact.outward_W = last_W;
  }
}

Contact contact_of(const ForceTraceRow& row, double begins_s, const Settings& s) {
  const Eigen::Quaterniond turn = rotation(kRadiansPerDegree * s.rotation_deg);
  Contact contact{row.time_s - begins_s, s.offset_m + turn * Vec3(s.scale * row.contact_m)};
  const Vec3 force_N = turn * row.force_N;
  if (force_N.norm() >= s.contact_force_N) contact.force_N = s.force_on_object ? Vec3(-force_N) : force_N;
  return contact;
}

// Adds a note on a contact that moves farther than a hand does, or faster.
void add_unusual_size(const Settings& s, const ForceTrace& trace, std::vector<Note>& notes) {
  constexpr double kLargest_m = 1, kFastest_m_per_s = 10;
  double speed = 0;
  BoundingBox box;
  for (std::size_t i = 0; i < trace.rows.size(); ++i) {
    box.extend(s.scale * trace.rows[i].contact_m);
    if (i == 0) continue;
    const Vec3 way_m = s.scale * (trace.rows[i].contact_m - trace.rows[i - 1].contact_m);
    speed = std::max(speed, way_m.norm() / (trace.rows[i].time_s - trace.rows[i - 1].time_s));
  }
  const double size_m = box.diagonal().norm();
  if (!(size_m > kLargest_m) && !(speed > kFastest_m_per_s)) return;
  const std::string text = formatted(": the contact moves through %.3g m at up to %.3g m/s: ", size_m, speed);
  notes.push_back({"unusual poses",
                   s.file + text +
                       (trace.states_length ? "times may be in another unit than the columns say"
                                            : "without units, lengths are metres; columns x_mm y_mm z_mm are "
                                              "millimetres")});
}

std::vector<Contact> contacts_in_file(const Settings& s, const Scenario& scenario, std::vector<Note>& notes) {
  const std::string file = find_input(s.file);
  const ForceTrace trace = read_force_trace(file, s.columns);
  const double start_s = trace.rows.front().time_s + s.start_s;
  const auto first = std::find_if(trace.rows.begin(), trace.rows.end(),
                                  [&](const ForceTraceRow& row) { return row.time_s >= start_s; });
  if (trace.rows.end() - first < 2)
    refuse("trajectory.start_s = " + std::to_string(s.start_s),
           "fewer than two rows of the file are left: expected a smaller value");
  const double duration_s = trace.rows.back().time_s - first->time_s;
  if (!(duration_s <= kMaxFileDuration_s))
    refuse(file, "lasts ", duration_s, " s: expected at most ", kMaxFileDuration_s,
           " s; times in milliseconds need a column time_ms");
  std::vector<Contact> contacts;
  for (auto row = first; row != trace.rows.end(); ++row)
    contacts.push_back(contact_of(*row, first->time_s, s));
  add_normals(file, scenario, contacts);
  if (!trace.unused.empty()) {
    std::string names;
    for (const std::string& name : trace.unused) names += (names.empty() ? "" : ", ") + name;
    notes.push_back({"columns unused", s.file + ": columns that are not used: " + names});
  }
  add_unusual_size(s, trace, notes);
  return contacts;
}

// --- a generated contact ---

// Returns the point of the true surface that is nearest to p; NaN if the surface is not known there.
Vec3 nearest_on_surface(const Scenario& scenario, Vec3 p_W, double time_s) {
  constexpr int kSteps = 8;  // one is enough for an exact distance; a search for it is repeated
  constexpr double kOnSurface_m = 1e-10;
  for (int step = 0; step < kSteps; ++step) {
    const double distance_m = scenario.signed_distance(p_W, time_s);
    if (std::isnan(distance_m)) return Vec3::Constant(distance_m);
    if (std::abs(distance_m) <= kOnSurface_m) break;
    const Vec3 normal_W = scenario.true_normal(p_W, time_s);
    if (!normal_W.allFinite()) break;  // over an edge: p is the best guess
    p_W -= distance_m * normal_W;
  }
  return p_W;
}

class GeneratedContact {
 public:
  GeneratedContact(const Settings& settings, const Scenario& scenario)
      : s_(settings), scenario_(scenario), timing_(settings) {}

  std::vector<Contact> contacts() {
    // A rest of a millionth of a row is a rounding error and not one more row.
    const int last = std::max(1, static_cast<int>(std::ceil(timing_.retreat_s * kRows_per_s - 1e-6)));
    std::vector<Contact> all;
    for (int i = 0; i <= last; ++i) all.push_back(at(i / kRows_per_s));
    return all;
  }

 private:
  Contact at(double time_s) {
    Contact contact{time_s, nearest_on_surface(scenario_, on_line(time_s), time_s)};
    if (!contact.position_W.allFinite()) refuse_surface(time_s);
    const Vec3 normal_W = scenario_.true_normal(contact.position_W, time_s);
    if (normal_W.allFinite()) outward_W_ = normal_W;  // stays, at an edge, that of the row before
    if (outward_W_.isZero(0)) refuse_surface(time_s);
    contact.outward_W = outward_W_;
    contact.gap_m = gap_m(time_s);
    contact.force_N = force_N(time_s) * outward_W_;
    return contact;
  }

  // Returns the point of the line at that time; over a height field it is moved vertically onto it.
  Vec3 on_line(double time_s) const {
    const double fraction =
        std::clamp((time_s - timing_.load_s) / (timing_.slide_s - timing_.load_s), 0.0, 1.0);
    Vec3 p_W = s_.from_m + fraction * (s_.to_m - s_.from_m);
    const double height_m = scenario_.surface_height(p_W.x(), p_W.z(), time_s);
    if (std::isfinite(height_m)) p_W.y() = height_m;
    return p_W;
  }

  double gap_m(double time_s) const {
    const double until_contact_s = std::max(timing_.approach_s - time_s, time_s - timing_.unload_s);
    return std::clamp(s_.speed_m_per_s * until_contact_s, 0.0, s_.clearance_m);
  }

  double force_N(double time_s) const {
    if (time_s <= timing_.approach_s || time_s >= timing_.unload_s) return 0;
    if (time_s < timing_.load_s) return s_.min_force_N * (time_s - timing_.approach_s) / s_.ramp_s;
    if (time_s <= timing_.slide_s) return force_while_sliding_N(time_s);
    return force_while_sliding_N(timing_.slide_s) * (timing_.unload_s - time_s) / s_.ramp_s;
  }

  double force_while_sliding_N(double time_s) const {
    const double periods = (time_s - timing_.load_s) / s_.force_period_s;
    const double cosine = sin_cos(kFullTurn_rad * (periods - std::floor(periods))).second;
    return 0.5 * (s_.min_force_N + s_.max_force_N) - 0.5 * (s_.max_force_N - s_.min_force_N) * cosine;
  }

  [[noreturn]] void refuse_surface(double time_s) const {
    const Vec3 p = on_line(time_s);
    refuse(kReplaySubject, "no true surface is known at ", p.x(), ", ", p.y(), ", ", p.z(),
           ": expected a line from_m to to_m over a surface, or a file");
  }

  const Settings& s_;
  const Scenario& scenario_;
  const Timing timing_;
  Vec3 outward_W_ = Vec3::Zero();  // normal of the row before
};

}  // namespace

ForceTrace read_force_trace(const std::filesystem::path& file, const std::string& traj_columns) {
  if (!has_ending(file, ".csv") && !has_ending(file, ".traj"))
    refuse(file.string(), "expected a file that ends in .csv or .traj");
  const std::string text = read_input_text(file, "expected rows of time, position and force");
  TraceReader reader(file, traj_columns);
  for_each_line(without_byte_order_mark(text), [&](std::size_t number, std::string_view untrimmed) {
    const std::string_view line = trimmed(untrimmed);
    if (!line.empty() && line[0] != '#' && line[0] != '%') reader.add(number, line);
  });
  return reader.take();
}

Parameters parameters(ContactReplay::Settings& s) {
  return {
      {"stiffness_N_per_m", &s.stiffness_N_per_m, 1, 1e6,
       "stiffness of the renderer under test; must be that of the renderer"},
      {"onset_distance_m", &s.onset_distance_m, 0, 1,
       "distance of the HIP from the surface at which the renderer's force begins: 0 for a proxy, contact_radius_m for penalty"},
      {"file", &s.file, 0, 0,
       "measured contact, .traj or .csv: time, position, force; empty: a contact on the true surface"},
      {"columns", &s.columns, 0, 0,
       "columns of a .traj file: time, x, y, z, fx, fy, fz with units (_s _ms _m _mm _N); others are not used"},
      {"start_s", &s.start_s, 0, 1e6, "time that is left out at the begin of the file"},
      {"scale", &s.scale, 1e-6, 1e6, "factor of the file's positions"},
      {"rotation_deg", &s.rotation_deg, -360, 360,
       "rotation vector (axis times angle) from the file's frame to the world"},
      {"offset_m", &s.offset_m, -1000, 1000, "position of the file's origin in the world"},
      {"force_on_object", &s.force_on_object, 0, 0,
       "true: the file has the force on the object; false: the force on the hand"},
      {"contact_force_N", &s.contact_force_N, 0, 1000, "smaller forces of the file count as free motion"},
      {"from_m", &s.from_m, -100, 100,
       "start of the line over which a generated contact moves; over a height field its height is not used"},
      {"to_m", &s.to_m, -100, 100, "end of that line"},
      {"speed_m_per_s", &s.speed_m_per_s, 1e-6, 100,
       "speed along that line, of the approach and of the retreat"},
      {"clearance_m", &s.clearance_m, 0, 10, "distance from contact at the start and at the end"},
      {"ramp_s", &s.ramp_s, 0, 100, "time in which the force rises from 0 and falls to 0"},
      {"min_force_N", &s.min_force_N, 0, 1000, "minimum of the force while the contact moves"},
      {"max_force_N", &s.max_force_N, 0, 1000, "maximum of the force; the minimum again: a constant force"},
      {"force_period_s", &s.force_period_s, 1e-3, 1000, "period of the force"},
  };
}

std::string validate(const ContactReplay::Settings& s) {
  if (!s.file.empty()) {
    const bool is_trace = has_ending(s.file, ".csv") || has_ending(s.file, ".traj");
    return is_trace ? "" : "file = " + s.file + ": expected a file that ends in .csv or .traj";
  }
  if (!((s.to_m - s.from_m).norm() > 0)) return "to_m: expected another position than from_m";
  if (s.min_force_N > s.max_force_N)
    return "min_force_N = " + std::to_string(s.min_force_N) + ": expected at most max_force_N";
  if (!(s.max_force_N > 0)) return "max_force_N = 0: expected above 0";
  const double duration_s = Timing(s).retreat_s;
  return duration_s <= kMaxDuration_s
             ? ""
             : "speed_m_per_s = " + std::to_string(s.speed_m_per_s) + ": the motion lasts " +
                   std::to_string(duration_s) + " s, expected at most " + std::to_string(kMaxDuration_s);
}

std::vector<InputPart> input_files(const ContactReplay::Settings& s) {
  if (s.file.empty()) return {};
  return {{s.file}};
}

ContactReplay::ContactReplay(const Settings& settings, const Scenario& scenario) {
  const std::vector<Contact> contacts = settings.file.empty()
                                            ? GeneratedContact(settings, scenario).contacts()
                                            : contacts_in_file(settings, scenario, notes_);
  for (const Contact& contact : contacts) {
    rows_.push_back(row_of(contact, settings));
    if (!is_near_origin(rows_.back().hip_W))
      throw InputError(far_from_origin(std::string(kReplaySubject) + ": the hand would be"));
  }
}

ContactReplay::Row ContactReplay::row_at(double time_s) const {
  const auto next = std::upper_bound(rows_.begin(), rows_.end(), time_s,
                                     [](double time, const Row& row) { return time < row.time_s; });
  if (next == rows_.end()) return rows_.back();
  if (next == rows_.begin()) return rows_.front();
  const Row &before = *(next - 1), &after = *next;
  const double fraction = (time_s - before.time_s) / (after.time_s - before.time_s);
  return {time_s, before.hip_W + fraction * (after.hip_W - before.hip_W),
          before.force_N + fraction * (after.force_N - before.force_N)};
}

std::vector<Phase> ContactReplay::phases() const {
  const auto touches = [](const Row& row) { return !row.force_N.isZero(0); };
  const auto first = std::find_if(rows_.begin(), rows_.end(), touches);
  const auto last = std::find_if(rows_.rbegin(), rows_.rend(), touches);
  if (first == rows_.end()) return {};
  return {{"the contact", first->time_s, last->time_s}};
}

}  // namespace remote_touch
