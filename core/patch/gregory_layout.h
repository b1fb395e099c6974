// The 20 points of a Gregory quad as a bicubic net with a pair at each inner place (patch.h). The file holds
// plain data only, because code compiled for a newer processor includes it.
#pragma once

namespace patchmill::internal {

// One corner of the patch and its pair of inner points.
struct GregoryCorner {
  int i, j;  // the pair's place in the bicubic net, each 1 or 2; 2 lies at u = 1 or v = 1
  // The pair. kCorner: `first` is weighted by the distance along u, `second` by that along v. kEdge: `first`
  // belongs to net 1, `second` to net 2.
  int first, second;
};
inline constexpr GregoryCorner kGregoryCorners[4] = {
    {1, 1, 3, 4}, {2, 1, 9, 8}, {2, 2, 13, 14}, {1, 2, 19, 18}};

// kGregoryNet[4 i + j]: number of point (i,j) of the bicubic net, with the second point of each pair.
inline constexpr int kGregoryNet[16] = {0, 2, 16, 15, 1, 4, 18, 17, 7, 8, 14, 11, 5, 6, 12, 10};

}  // namespace patchmill::internal
