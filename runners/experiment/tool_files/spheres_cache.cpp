#include "runners/experiment/tool_files/spheres_cache.h"

#include "runners/experiment/provenance/cache_file.h"

namespace remote_touch {

namespace fs = std::filesystem;

namespace {

const CacheKind kSpheresKind{"spheres", kSpheresFormat};

// A tree as lists. It can be built again from its leaves and the number of leaves of each node of the lowest
// level.
struct FlatTree {
  std::vector<double> leaves;  // x, y, z, radius
  std::vector<std::uint32_t> counts;
};

FlatTree flat(const SphereTree& tree) {
  FlatTree all;
  for (const Sphere& leaf : tree.leaves())
    all.leaves.insert(all.leaves.end(), {leaf.centre.x(), leaf.centre.y(), leaf.centre.z(), leaf.radius_m});
  if (!tree.empty())
    for (const SphereNode& node : tree.level(0)) all.counts.push_back(node.count);
  return all;
}

// Builds the tree. Returns false if the counts do not fit the number of leaves, or if there are none.
bool grow(const FlatTree& flat, SphereTree& tree) {
  std::size_t at = 0;
  for (const std::size_t count : flat.counts) {
    if (count == 0 || 4 * count > flat.leaves.size() - at) return false;
    std::vector<Sphere> node;
    for (std::size_t i = 0; i < count; ++i, at += 4)
      node.push_back({{flat.leaves[at], flat.leaves[at + 1], flat.leaves[at + 2]}, flat.leaves[at + 3]});
    tree.add(node);
  }
  if (tree.empty() || at != flat.leaves.size()) return false;
  tree.finish();
  return true;
}

// Packs or unpacks every field, in the same order.
template <class Direction, class Tree, class Spheres>
void visit(Direction& pack, Tree& tree, Spheres& spheres) {
  pack.list(tree.leaves), pack.list(tree.counts);
  pack.value(spheres.inflation_m), pack.value(spheres.outside_m), pack.value(spheres.surface_outside_m);
}

}  // namespace

std::string spheres_key(const std::string& tool_key, int max_leaves) {
  CacheWriter pack;
  pack.text(tool_key);
  pack.value(max_leaves);
  return pack.hex();
}

std::optional<ToolSpheres> read_spheres(const fs::path& folder, const std::string& key) {
  ToolSpheres spheres;
  FlatTree tree;
  const auto take = [&](Unpacker& unpack) { visit(unpack, tree, spheres); };
  if (!read_cache_file(folder, kSpheresKind, key, take) || !grow(tree, spheres.spheres)) return {};
  return spheres;
}

bool write_spheres(const fs::path& folder, const std::string& key, const ToolSpheres& spheres) {
  const FlatTree tree = flat(spheres.spheres);
  return write_cache_file(folder, kSpheresKind, key, [&](CacheWriter& pack) { visit(pack, tree, spheres); });
}

}  // namespace remote_touch
