// Constants of the search for the nearest position on a disk, and of the contact computed from it. They are
// shared by near_disks.cpp and the kernel that processes many disks at once.
#pragma once

namespace remote_touch::disk_search {

inline constexpr int kLines = 2;            // lines to search: one for an edge of the tool, two for a corner
inline constexpr int kCuts = 4;             // cuts of a line
inline constexpr double kFlatSlope = 0.05;  // largest slope of the field in which a disk counts as flat
inline constexpr double kFlatDepth_m = 1e-5;  // largest rise of the field over a flat disk of merged points
inline constexpr double kEdgeOnSine =
    0.2;                                 // largest sine of the angle between an edge-on disk and the gradient
inline constexpr double kStep_m = 2e-4;  // step off the plane of a disk, to see where the tool continues
inline constexpr double kMinGradient = 0.5;  // a shorter gradient deep in the tool shows no side: a ridge

}  // namespace remote_touch::disk_search
