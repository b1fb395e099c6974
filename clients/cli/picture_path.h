// The path of a job as one polyline, with what a picture draws of it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clients/render/camera.h"
#include "clients/render/color.h"
#include "patchmill/v1/toolpath.pb.h"

namespace patchmill::cli {

// What a move is drawn as. Behind kFirstPass come the kinds of passes, by PassKind.
enum PathClass : std::uint8_t { kRapid, kApproach, kLead, kLink, kCutOfNoPass, kFirstPass };

struct PathPoint {
  render::Point tip;                 // mm
  std::uint8_t path_class = kRapid;  // of the segment that ends here
  // Every 2^rank-th pass, and the leads and links in front of it, have this rank or more; 255: always drawn.
  std::uint8_t rank = 255;
};

struct PicturePath {
  std::vector<PathPoint> points;
  // Distance between neighbouring passes by PathClass, mm: area of the part over their length; infinite where
  // there is none.
  std::vector<double> spacing_mm;
};

// `chord_mm`: how far the polyline may be from an arc. `area_mm2`: of the part.
PicturePath MakePicturePath(const std::vector<v1::PathBlock>& blocks, double chord_mm, double area_mm2);

// The least rank that is drawn of each class where a pixel has this size: passes are at least 3 px apart.
std::vector<std::uint8_t> LeastRanks(const PicturePath& path, double pixel_mm);

render::Rgb PathColor(std::uint8_t path_class);
std::string PathName(std::uint8_t path_class);  // "contour passes"

}  // namespace patchmill::cli
