#include "core/dissertation/tool/contact/contact_thinning.h"

#include <algorithm>
#include <bit>

#include "core/kernels/tool_kernels.h"

namespace remote_touch {

namespace {

constexpr int kMaxTries = 64;

}  // namespace

std::uint64_t cell_number(const Vec3& p_T, double cells_per_m) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double whole = p_T[axis] * cells_per_m - kAlmostHalf + kRoundsToWhole;  // no call of the C library
    key = key << 20 | (std::bit_cast<std::uint64_t>(whole) & 0xfffff);
  }
  return key;
}

std::uint64_t cell_and_octant(const Vec3& p_T, const Vec3& direction_T, double cells_per_m) {
  std::uint64_t key = cell_number(p_T, cells_per_m);
  for (int axis = 0; axis < 3; ++axis) key = key << 1 | (direction_T[axis] < 0 ? 1u : 0u);
  return key;
}

// Returns the slot that has held a key since begin(), or else an unused one; null if kMaxTries slots hold
// other keys.
ContactThinning::Slot* ContactThinning::slot_of(std::uint64_t key) {
  std::size_t at = first_slot(key);
  for (int tries = 0; tries < kMaxTries; ++tries, at = (at + 1) % kSlots)
    if (slots_[at].stamp != stamp_ || slots_[at].key == key) return &slots_[at];
  return nullptr;
}

void ContactThinning::begin() {
  if (++stamp_ == 0) {  // an old stamp must not count as current after 2^32 calls
    std::fill(slots_.begin(), slots_.end(), Slot{});
    stamp_ = 1;
  }
  cells_ = 0;
}

std::size_t ContactThinning::find_cell(std::uint64_t key) {
  Slot* slot = slot_of(key);
  if (!slot) return kNoCell;
  if (slot->stamp != stamp_) *slot = {key, cells_++, stamp_};
  return slot->cell;
}

void ContactThinning::thin(std::vector<ToolContact>& contacts, std::size_t max) {
  constexpr double kGrowth = 1.5;
  for (double cell_m = kCell_m; contacts.size() > max; cell_m *= kGrowth) thin_in_cells(contacts, cell_m);
}

void ContactThinning::thin_in_cells(std::vector<ToolContact>& contacts, double cell_m) {
  begin();
  std::size_t kept = 0, read = 0;
  for (; read < contacts.size(); ++read) {  // only contacts already read are overwritten
    const ToolContact& contact = contacts[read];
    const std::size_t place = cell(cell_and_octant(contact.r_T, contact.n_T, 1 / cell_m));
    if (place == kNoCell) break;
    if (place == kept)
      contacts[kept++] = contact;
    else if (contact.depth_m > contacts[place].depth_m)
      contacts[place] = contact;
  }
  const auto first_unread = contacts.begin() + static_cast<std::ptrdiff_t>(read);
  contacts.erase(contacts.begin() + static_cast<std::ptrdiff_t>(kept), first_unread);
}

}  // namespace remote_touch
