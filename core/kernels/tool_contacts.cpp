// The contacts of many disks at once. The operations are those of near_points.cpp, in their order, and are
// explained there.
#include "core/kernels/field_lanes.h"
#include "core/kernels/level.h"
#include "core/kernels/tool_kernels.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

using namespace disk_search;

struct FieldAt {
  Doubles distance;
  Doubles3 gradient_T;
};

struct DiskLanes {
  Doubles3 p_T, n_T;
  Doubles radius, extent;
  FieldAt at;
  Flags has_normal;
};

struct PositionLanes {
  Doubles3 p_T;
  FieldAt at;
  Flags at_rim, is_known;
};

struct ContactLanes {
  Doubles3 p_T, n_T;
  Doubles depth, side;
};

// Numbers of disks for all lanes. If a list does not fill its last vector, its last disk is repeated.
struct Numbers {
  std::uint32_t at[kDoubles];

  Numbers(const std::uint32_t* number, std::size_t count) {
    for (std::size_t lane = 0; lane < kDoubles; ++lane) at[lane] = number[lane < count ? lane : count - 1];
  }
  Doubles of(const double* column) const {
    Doubles a;
    for (std::size_t lane = 0; lane < kDoubles; ++lane) a[lane] = column[at[lane]];
    return a;
  }
  Doubles3 of(double* const (&columns)[3]) const { return {of(columns[0]), of(columns[1]), of(columns[2])}; }
};

inline Flags is_finite(const Doubles3& a) {
  return (a.x - a.x == 0) & (a.y - a.y == 0) & (a.z - a.z == 0);
}

inline DiskLanes disks_of(const DiskColumns& disks, const Numbers& numbers) {
  const Doubles3 n = numbers.of(disks.n_T);
  return {numbers.of(disks.p_T),
          n,
          numbers.of(disks.radius),
          numbers.of(disks.extent),
          {numbers.of(disks.distance), numbers.of(disks.gradient_T)},
          is_finite(n)};
}

inline Doubles facing_side(const Doubles3& n_T, const Doubles3& gradient_T, Doubles steep) {
  const Doubles facing = -dot(gradient_T, n_T);
  const Doubles side = facing < 0 ? broadcast(-1) : broadcast(1);
  return magnitude(facing) <= kEdgeOnSine * steep ? Doubles{} : side;
}

inline Doubles3 exit_direction(const Doubles3& gradient_T, Doubles steep) {
  return chosen(steep > 0, -gradient_T / Divisor(steep), {Doubles{}, broadcast(1), Doubles{}});
}

inline ContactLanes far_contacts(const DiskColumns& disks, const Numbers& numbers) {
  const Doubles3 n = numbers.of(disks.n_T), gradient_T = numbers.of(disks.gradient_T);
  const Doubles steep = norm(gradient_T);
  return {numbers.of(disks.p_T), exit_direction(gradient_T, steep), -numbers.of(disks.lower),
          is_finite(n) ? facing_side(n, gradient_T, steep) : Doubles{}};
}

struct EndLanes {
  Doubles t;
  FieldAt at;
  Doubles slope;
};

inline EndLanes chosen(Flags flags, const EndLanes& a, const EndLanes& b) {
  return {flags ? a.t : b.t,
          {flags ? a.at.distance : b.at.distance, chosen(flags, a.at.gradient_T, b.at.gradient_T)},
          flags ? a.slope : b.slope};
}

// Searches one line in the lanes that are `active`. Returns the lanes whose position moved and is not at the
// rim of the disk.
Flags slide(const PosedField& field, const DiskLanes& disk, Flags active, PositionLanes& position) {
  const Doubles3 along = position.at.gradient_T - dot(position.at.gradient_T, disk.n_T) * disk.n_T;
  const Doubles steep = norm(along);
  active &= ~is_flat(steep, disk.radius, disk.extent);
  if (!is_any(active)) return Flags{};
  const Doubles3 start_T = position.p_T, direction_T = -along / Divisor(steep), offset = start_T - disk.p_T;
  const Doubles ahead = dot(offset, direction_T), inside = disk.radius * disk.radius - dot(offset, offset);
  const auto end = [&](Doubles t, Flags sampled) {
    const FieldLanes at = sample(field, start_T + t * direction_T);
    position.is_known &= at.is_known | ~sampled;
    return EndLanes{t, {at.distance, at.gradient_T}, dot(at.gradient_T, direction_T)};
  };
  const Doubles squared = ahead * ahead + inside;
  EndLanes low{Doubles{}, position.at, -steep},
      high = end(root(0 < squared ? squared : Doubles{}) - ahead, active);
  const Flags at_rim = (high.slope < -kFlatSlope) & (high.at.distance < low.at.distance);
  Flags cuts = active & ~at_rim;
  for (int cut = 0; cut < kCuts; ++cut) {
    const Doubles bent = high.slope - low.slope;
    const Doubles meet =
        (low.at.distance - high.at.distance + high.slope * high.t - low.slope * low.t) / bent;
    cuts &= (bent > kFlatSlope) & (meet > low.t) & (meet < high.t);
    if (!is_any(cuts)) break;
    const EndLanes between = end(meet, cuts);
    const Flags is_low = between.slope < 0;
    low = chosen(cuts & is_low, between, low);
    high = chosen(cuts & ~is_low, between, high);
  }
  EndLanes best = chosen(high.at.distance <= low.at.distance, high, low);
  const Doubles bent = high.slope - low.slope, part = high.slope / bent;
  const Doubles above = part < 0 ? Doubles{} : part, fraction = 1 < above ? broadcast(1) : above;
  best.at.gradient_T =
      chosen(~at_rim & (low.slope < 0) & (high.slope > low.slope),
             fraction * low.at.gradient_T + (1 - fraction) * high.at.gradient_T, best.at.gradient_T);
  position.p_T = chosen(active, start_T + best.t * direction_T, position.p_T);
  position.at.distance = active ? best.at.distance : position.at.distance;
  position.at.gradient_T = chosen(active, best.at.gradient_T, position.at.gradient_T);
  position.at_rim |= active & at_rim;
  return active & ~at_rim & (best.t > 0);
}

inline Flags rises_beyond(const PosedField& field, const DiskLanes& disk, PositionLanes& position,
                          double side, Flags sampled) {
  const FieldLanes beyond = sample(field, position.p_T - broadcast(side * kStep_m) * disk.n_T);
  position.is_known &= beyond.is_known | ~sampled;
  return beyond.distance - position.at.distance > 0.5 * kStep_m;
}

// depth is NaN if the search left the grid.
ContactLanes near_contacts(const PosedField& field, const DiskLanes& disk, double known_side) {
  PositionLanes position{disk.p_T, disk.at, Flags{}, ~Flags{}};
  Flags active = disk.has_normal & (disk.radius > 0);
  for (int line = 0; line < kLines && is_any(active); ++line) active = slide(field, disk, active, position);

  const Doubles steep = norm(position.at.gradient_T);
  const Flags is_inside = position.at.distance < 0;
  const Flags known = known_side != 0 ? is_inside : Flags{};
  const Flags is_blind = (position.at.distance < -field.size) & (steep < kMinGradient);
  const Doubles facing = facing_side(disk.n_T, position.at.gradient_T, steep);
  Doubles side = is_blind ? broadcast(1) : facing;
  side = known ? broadcast(known_side) : side;
  side = disk.has_normal ? side : Doubles{};
  Flags as_plane = (side != 0) & (~position.at_rim | known);
  const Flags sampled = ~as_plane & disk.has_normal;
  if (is_any(sampled)) {
    const Flags front = rises_beyond(field, disk, position, 1, sampled),
                back = rises_beyond(field, disk, position, -1, sampled);
    const Flags is_flush = sampled & (front ^ back);
    const Doubles flush = front ? broadcast(1) : broadcast(-1);
    side = is_flush ? flush : side;
    as_plane |= is_flush;
  }
  const Doubles3 out = chosen(as_plane, side * disk.n_T, exit_direction(position.at.gradient_T, steep));
  return {position.p_T, out, position.is_known ? -position.at.distance : broadcast(__builtin_nan("")), side};
}

// Stores the contacts of one vector: lane k is the contact out[from[k]].
void put(const ContactLanes& contacts, const std::uint32_t* from, std::size_t count, ContactNumbers* out) {
  double column[8][kDoubles];
  const Doubles three[2][3] = {{contacts.p_T.x, contacts.p_T.y, contacts.p_T.z},
                               {contacts.n_T.x, contacts.n_T.y, contacts.n_T.z}};
  for (int k = 0; k < 6; ++k) store(column[k], three[k / 3][k % 3]);
  store(column[6], contacts.depth), store(column[7], contacts.side);
  for (std::size_t lane = 0; lane < kDoubles && lane < count; ++lane)
    out[from[lane]] = {{column[0][lane], column[1][lane], column[2][lane]},
                       {column[3][lane], column[4][lane], column[5][lane]},
                       column[6][lane],
                       column[7][lane]};
}

}  // namespace

void disk_contacts(const DiskColumns& disks, const std::uint32_t* number, std::size_t count,
                   const PosedField& field, double search_m, double known_side, ContactNumbers* out) {
  constexpr std::size_t kChunk = 512;
  // Disks in which the field is flat are grouped together, because none of them needs a search.
  enum Kind { kFar, kFlat, kSteep, kKinds };
  for (std::size_t first = 0; first < count; first += kChunk) {
    const std::size_t size = count - first < kChunk ? count - first : kChunk;
    std::uint32_t disk[kKinds][kChunk], row[kKinds][kChunk];
    std::size_t n[kKinds] = {};
    for (std::size_t k = first; k < first + size; ++k) {
      const std::uint32_t i = number[k];
      const bool is_near = disks.lower[i] <= search_m, is_exact = disks.bound[i] == disks.distance[i];
      const Kind kind = !is_near ? kFar : is_exact ? kFlat : kSteep;
      disk[kind][n[kind]] = i, row[kind][n[kind]++] = static_cast<std::uint32_t>(k);
    }
    for (int kind = kFar; kind < kKinds; ++kind)
      for (std::size_t k = 0; k < n[kind]; k += kDoubles) {
        const Numbers numbers(disk[kind] + k, n[kind] - k);
        put(kind == kFar ? far_contacts(disks, numbers)
                         : near_contacts(field, disks_of(disks, numbers), known_side),
            row[kind] + k, n[kind] - k, out);
      }
  }
}

// The kernels of a tool, which are in several files.
Kernel<&ToolKernels::near_spheres> near_spheres;
Kernel<&ToolKernels::slabs_in_field> slabs_in_field;
Kernel<&ToolKernels::slabs_on_way> slabs_on_way;
Kernel<&ToolKernels::points_in_cells> points_in_cells;
Kernel<&ToolKernels::disks_in_field> disks_in_field;
Kernel<&ToolKernels::points_in_field> points_in_field;
Kernel<&ToolKernels::touched_points> touched_points;

const ToolKernels kToolKernels = {
    .near_spheres = near_spheres,
    .slabs_in_field = slabs_in_field,
    .slabs_on_way = slabs_on_way,
    .points_in_cells = points_in_cells,
    .disks_in_field = disks_in_field,
    .points_in_field = points_in_field,
    .touched_points = touched_points,
    .disk_contacts = disk_contacts,
};

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
