// The inner loops over points and pixels, compiled once for each x86-64 level and selected at run time. There
// is one table of functions for each domain. Code that calls a domain's kernels includes its header, e.g.
// depth_kernels.h; code that only passes the tables on includes this one.
//
// The results have the same bits on every level and for every order of the points: every term is computed by
// itself in IEEE arithmetic without contraction, minima and maxima do not depend on order, and sums over
// points are exact. A sum is exact because each term is first rounded to a fixed grid: with M = 1.5 * 2^m, (t
// + M) - M rounds t to a multiple of 2^(m-52), and up to 2^m terms of magnitude at most 1 are then added
// without rounding (pre-rounding, Demmel and Nguyen 2013). The price is an absolute error of up to 2^(m-53)
// per term, 2.8e-14 for up to 255 points.
#pragma once

#include <cstddef>
#include <span>

namespace remote_touch {

struct GatherKernels;
struct ProxyKernels;
struct NoiseKernels;
struct ToolKernels;
struct RegionKernels;
struct PatchKernels;
struct DepthKernels;

struct Kernels {
  const char* isa;
  const GatherKernels& gather;
  const ProxyKernels& proxy;
  const NoiseKernels& noise;
  const ToolKernels& tool;
  const RegionKernels& regions;
  const PatchKernels& patch;
  const DepthKernels& depth;
};

// Padding of columns to whole groups of kLanes. Each x86-64 level reads a group in one or several vectors.
inline constexpr std::size_t kLanes = 8;
inline constexpr double kFarAway = 1e100;  // coordinate of a padding point; its square is still finite

// The x86-64 levels of the kernels, in rising order.
enum class Isa { x86_64, x86_64_v3, x86_64_v4 };

Isa best_isa();                   // the highest level of the running machine
const Kernels& kernels_for(Isa);  // pre: the machine has that level
// Kernels of every level that the running machine supports, in rising order.
std::span<const Kernels* const> supported_kernels();

}  // namespace remote_touch
