// The contacts of disks, for many disks at once: the operations of disk_contact.cpp in their order, where
// they are explained.
#include "core/kernels/disk_search.h"
#include "core/kernels/field_lanes.h"
#include "core/kernels/level.h"

namespace remote_touch::REMOTE_TOUCH_LEVEL {

namespace {

using namespace disk_search;

struct FieldAt {
  Doubles distance;
  Doubles3 gradient_T;
};

struct DiskLanes {
  Doubles3 p_T, n_T;
  Doubles radius, extent, lower;
  FieldAt at;
  Flags has_normal;
};

struct PlaceLanes {
  Doubles3 p_T;
  FieldAt at;
  Flags at_rim, is_known;
};

struct ContactLanes {
  Doubles3 p_T, n_T;
  Doubles depth, side;
};

// The last lanes of a list that is no multiple of their number repeat its last disk.
DiskLanes disks_of(const DiskColumns& disks, const std::uint32_t* number, std::size_t count) {
  std::uint32_t at[kDoubles];
  for (std::size_t lane = 0; lane < kDoubles; ++lane) at[lane] = number[lane < count ? lane : count - 1];
  const auto of = [&](const double* column) {
    double one[kDoubles];
    for (std::size_t lane = 0; lane < kDoubles; ++lane) one[lane] = column[at[lane]];
    return load(one);
  };
  const auto three = [&](double* const(&columns)[3]) {
    return Doubles3{of(columns[0]), of(columns[1]), of(columns[2])};
  };
  const Doubles3 n = three(disks.n_T);
  return {three(disks.p_T),
          n,
          of(disks.radius),
          of(disks.extent),
          of(disks.lower),
          {of(disks.distance), three(disks.gradient_T)},
          (n.x - n.x == 0) & (n.y - n.y == 0) & (n.z - n.z == 0)};
}

inline Doubles facing_side(const DiskLanes& disk, const Doubles3& gradient_T, Doubles steep) {
  const Doubles facing = -dot(gradient_T, disk.n_T);
  const Doubles side = facing < 0 ? all(-1) : all(1);
  return magnitude(facing) <= kGrazing * steep ? Doubles{} : side;
}

inline Doubles3 exit_direction(const Doubles3& gradient_T, Doubles steep) {
  return chosen(steep > 0, -gradient_T / steep, {Doubles{}, all(1), Doubles{}});
}

ContactLanes far_contacts(const DiskLanes& disk) {
  const Doubles steep = norm(disk.at.gradient_T);
  const Doubles side = facing_side(disk, disk.at.gradient_T, steep);
  return {disk.p_T, exit_direction(disk.at.gradient_T, steep), -disk.lower,
          disk.has_normal ? side : Doubles{}};
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

inline Flags is_flat(const DiskLanes& disk, Doubles slope) {
  return (slope < kFlatSlope) & ((disk.extent == 0) | (slope * disk.radius < kFlatDepth_m));
}

// One line of those lanes that are `active`. Returns where it went anywhere and did not end at the rim.
Flags slide(const PosedField& field, const DiskLanes& disk, Flags active, PlaceLanes& place) {
  const Doubles3 along = place.at.gradient_T - dot(place.at.gradient_T, disk.n_T) * disk.n_T;
  const Doubles steep = norm(along);
  active &= ~is_flat(disk, steep);
  if (!is_any(active)) return Flags{};
  const Doubles3 start_T = place.p_T, direction_T = -along / steep, offset = start_T - disk.p_T;
  const Doubles ahead = dot(offset, direction_T), inside = disk.radius * disk.radius - dot(offset, offset);
  const auto end = [&](Doubles t, Flags looks) {
    const FieldLanes at = sample(field, start_T + t * direction_T);
    place.is_known &= at.is_known | ~looks;
    return EndLanes{t, {at.distance, at.gradient_T}, dot(at.gradient_T, direction_T)};
  };
  const Doubles squared = ahead * ahead + inside;
  EndLanes low{Doubles{}, place.at, -steep},
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
  const Doubles above = part < 0 ? Doubles{} : part, fraction = 1 < above ? all(1) : above;
  best.at.gradient_T =
      chosen(~at_rim & (low.slope < 0) & (high.slope > low.slope),
             fraction * low.at.gradient_T + (1 - fraction) * high.at.gradient_T, best.at.gradient_T);
  place.p_T = chosen(active, start_T + best.t * direction_T, place.p_T);
  place.at.distance = active ? best.at.distance : place.at.distance;
  place.at.gradient_T = chosen(active, best.at.gradient_T, place.at.gradient_T);
  place.at_rim |= active & at_rim;
  return active & ~at_rim & (best.t > 0);
}

inline Flags leaves(const PosedField& field, const DiskLanes& disk, PlaceLanes& place, double side,
                    Flags looks) {
  const FieldLanes beyond = sample(field, place.p_T - all(side * kStep_m) * disk.n_T);
  place.is_known &= beyond.is_known | ~looks;
  return beyond.distance - place.at.distance > 0.5 * kStep_m;
}

// depth is NaN where the search has left the grid.
ContactLanes near_contacts(const PosedField& field, const DiskLanes& disk, double known_side) {
  PlaceLanes place{disk.p_T, disk.at, Flags{}, ~Flags{}};
  Flags active = disk.has_normal & (disk.radius > 0);
  for (int line = 0; line < kLines && is_any(active); ++line) active = slide(field, disk, active, place);

  const Doubles steep = norm(place.at.gradient_T);
  const Flags is_inside = place.at.distance < 0;
  const Flags known = known_side != 0 ? is_inside : Flags{};
  const Flags is_blind = (place.at.distance < -field.size) & (steep < kBlindGradient);
  const Doubles facing = facing_side(disk, place.at.gradient_T, steep);
  Doubles side = is_blind ? all(1) : facing;
  side = known ? all(known_side) : side;
  side = disk.has_normal ? side : Doubles{};
  Flags as_plane = (side != 0) & (~place.at_rim | known);
  const Flags looks = ~as_plane & disk.has_normal;
  if (is_any(looks)) {
    const Flags front = leaves(field, disk, place, 1, looks), back = leaves(field, disk, place, -1, looks);
    const Flags is_flush = looks & (front ^ back);
    const Doubles flush = front ? all(1) : all(-1);
    side = is_flush ? flush : side;
    as_plane |= is_flush;
  }
  const Doubles3 out = chosen(as_plane, side * disk.n_T, exit_direction(place.at.gradient_T, steep));
  return {place.p_T, out, place.is_known ? -place.at.distance : all(__builtin_nan("")), side};
}

// Of the disks number[from[0]], number[from[1]] ..; contacts have the places from[0], from[1] .. themselves.
void put(const ContactLanes& contacts, const std::uint32_t* from, std::size_t count,
         const ContactColumns& out) {
  const auto scatter = [&](double* column, Doubles value) {
    double one[kDoubles];
    store(one, value);
    for (std::size_t lane = 0; lane < kDoubles && lane < count; ++lane) column[from[lane]] = one[lane];
  };
  scatter(out.r_T[0], contacts.p_T.x), scatter(out.r_T[1], contacts.p_T.y),
      scatter(out.r_T[2], contacts.p_T.z);
  scatter(out.n_T[0], contacts.n_T.x), scatter(out.n_T[1], contacts.n_T.y),
      scatter(out.n_T[2], contacts.n_T.z);
  scatter(out.depth, contacts.depth), scatter(out.side, contacts.side);
}

}  // namespace

void disk_contacts(const DiskColumns& disks, const std::uint32_t* number, std::size_t count,
                   const PosedField& field, double search_m, double known_side, const ContactColumns& out) {
  constexpr std::size_t kChunk = 64;
  for (std::size_t first = 0; first < count; first += kChunk) {
    const std::size_t size = count - first < kChunk ? count - first : kChunk;
    std::uint32_t disk[2][kChunk], place[2][kChunk];  // far ones, near ones
    std::size_t n[2] = {0, 0};
    for (std::size_t k = first; k < first + size; ++k) {
      const bool is_near = disks.lower[number[k]] <= search_m;
      for (int kind = 0; kind < 2; ++kind)
        disk[kind][n[kind]] = number[k], place[kind][n[kind]] = static_cast<std::uint32_t>(k),
        n[kind] += is_near == (kind == 1) ? 1 : 0;
    }
    for (std::size_t k = 0; k < n[0]; k += kDoubles)
      put(far_contacts(disks_of(disks, disk[0] + k, n[0] - k)), place[0] + k, n[0] - k, out);
    for (std::size_t k = 0; k < n[1]; k += kDoubles)
      put(near_contacts(field, disks_of(disks, disk[1] + k, n[1] - k), known_side), place[1] + k, n[1] - k,
          out);
  }
}

}  // namespace remote_touch::REMOTE_TOUCH_LEVEL
