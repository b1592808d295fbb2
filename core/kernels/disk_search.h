// Constants of the search for the nearest position of a disk, and of the contact made from it. Shared by
// disk_contact.cpp and the kernel that does the same for many disks at once.
#pragma once

namespace remote_touch::disk_search {

inline constexpr int kLines = 2;            // lines to search: one for an edge of the tool, two for a corner
inline constexpr int kCuts = 4;             // cuts of a line
inline constexpr double kFlatSlope = 0.05;  // largest slope of the field in which a disk counts as flat
inline constexpr double kFlatDepth_m =
    1e-5;                                // largest rise of the field over a disk of many points, likewise
inline constexpr double kGrazing = 0.2;  // a disk at a smaller angle to the gradient is met at its edge
inline constexpr double kStep_m = 2e-4;  // lower edges are climbed, not run into
inline constexpr double kBlindGradient = 0.5;  // a shorter gradient is at a ridge: it has no direction

}  // namespace remote_touch::disk_search
