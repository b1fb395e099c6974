// Slower feed in the inner corners of passes, where the ball cuts more than along a straight wall.
#pragma once

#include "cam/toolpath/toolpath.h"

namespace patchmill {

struct CornerFeedParams {
  double feed = 0.0;   // mm/min, of passes
  double least = 0.0;  // mm/min, in the tightest corners; nothing changes where it is not below `feed`
};

struct CornerFeedResult {
  Toolpath toolpath;
  double slowed_length = 0.0;  // mm, of pass moves that are slower than before
};

// In an inner corner the place where the ball cuts runs ahead of the ball's centre. With the ball radius R
// and the radius r on which the centre turns away from the contact, that place moves at (r + R) / r times
// the feed. So the feed there is
//
//     feed r / (r + R) = feed / (1 + R k),    k = turn / length, the mean curvature away from the contact,
//
// over the path from half a ball radius before a place to half a ball radius behind it. Feeds are rounded
// to tenths of the feed, and never below `least`. Faster stretches shorter than half a ball radius are
// joined with the faster of their neighbours. Moves are divided where the feed changes, and the path stays as
// it is. Only moves of passes become slower, none becomes faster. Contours that close are treated as closed.
// Cost O(n log n).
CornerFeedResult WithCornerFeeds(Toolpath toolpath, const CornerFeedParams& params);

}  // namespace patchmill
