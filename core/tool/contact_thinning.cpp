#include "core/tool/contact_thinning.h"

namespace remote_touch {

namespace {

constexpr int kMostTries = 64;

std::uint64_t key_of(const ToolContact& contact, double cell_m) {
  std::uint64_t key = cell_number(contact.r_T, cell_m);
  for (int axis = 0; axis < 3; ++axis) key = key << 1 | (contact.n_T[axis] < 0 ? 1u : 0u);
  return key;
}

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

void ContactThinning::thin(std::vector<ToolContact>& contacts, double cell_m) {
  ++stamp_;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ToolContact& contact = contacts[i];  // no place before it is its own
    const std::uint64_t key = key_of(contact, cell_m);
    Slot* slot = slot_of(key);
    if (!slot) continue;
    if (slot->stamp != stamp_) {
      *slot = {key, kept, stamp_};
      if (kept != i) contacts[kept] = contact;
      ++kept;
    } else if (contact.depth_m > contacts[slot->place].depth_m) {
      contacts[slot->place] = contact;
    }
  }
  contacts.resize(kept);
}

}  // namespace remote_touch
