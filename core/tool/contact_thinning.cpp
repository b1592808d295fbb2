#include "core/tool/contact_thinning.h"

namespace remote_touch {

namespace {

constexpr int kMostTries = 64;

// std::floor() would be a call of the C library on the oldest machines.
std::int64_t floor_of(double x) {
  const auto towards_zero = static_cast<std::int64_t>(x);
  return towards_zero - (x < static_cast<double>(towards_zero) ? 1 : 0);
}

}  // namespace

std::uint64_t cell_number(const Vec3& p_T, double cell_m) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    key = key << 20 | (static_cast<std::uint64_t>(floor_of(p_T[axis] / cell_m)) & 0xfffff);
  }
  return key;
}

// The slot of a key in this call, or an unused one; null in a crowded table.
ContactThinning::Slot* ContactThinning::slot_of(std::uint64_t key) {
  std::size_t at = (key * 0x9e3779b97f4a7c15u) >> 52;
  for (int tries = 0; tries < kMostTries; ++tries, at = (at + 1) % kMostCells)
    if (slots_[at].stamp != stamp_ || slots_[at].key == key) return &slots_[at];
  return nullptr;
}

void ContactThinning::begin(double cell_m) {
  ++stamp_;
  cell_m_ = cell_m, kept_ = 0;
}

std::size_t ContactThinning::place(const Vec3& r_T, const Vec3& n_T, double depth_m) {
  std::uint64_t key = cell_number(r_T, cell_m_);
  for (int axis = 0; axis < 3; ++axis) key = key << 1 | (n_T[axis] < 0 ? 1u : 0u);
  Slot* slot = slot_of(key);
  if (!slot) return kNowhere;
  if (slot->stamp != stamp_) {
    *slot = {key, depth_m, kept_, stamp_};
    return kept_++;
  }
  if (!(depth_m > slot->depth_m)) return kNowhere;
  slot->depth_m = depth_m;
  return slot->place;
}

void ContactThinning::thin(std::vector<ToolContact>& contacts, double cell_m) {
  begin(cell_m);
  for (const ToolContact& contact : contacts) {  // no place before it is its own
    const std::size_t place = this->place(contact.r_T, contact.n_T, contact.depth_m);
    if (place != kNowhere) contacts[place] = contact;
  }
  contacts.resize(kept_);
}

}  // namespace remote_touch
