#include "cam/region/map/region_map.h"

namespace patchmill {

const char* Name(RegionKind kind) {
  switch (kind) {
    case RegionKind::kMountain:
      return "mountain";
    case RegionKind::kBasin:
      return "basin";
    case RegionKind::kNeutral:
      return "neutral";
    case RegionKind::kUnreachable:
      return "unreachable";
  }
  return "";
}

const char* Name(SlopeClass slope) {
  switch (slope) {
    case SlopeClass::kUnspecified:
      return "unspecified";
    case SlopeClass::kSteep:
      return "steep";
    case SlopeClass::kGentle:
      return "gentle";
  }
  return "";
}

const char* Name(UnreachableReason reason) {
  switch (reason) {
    case UnreachableReason::kNone:
      return "NONE";
    case UnreachableReason::kUndercut:
      return "UNDERCUT";
    case UnreachableReason::kConcave:
      return "CONCAVE";
    case UnreachableReason::kFloor:
      return "FLOOR";
    case UnreachableReason::kAvoided:
      return "AVOIDED";
    case UnreachableReason::kStrategy:
      return "STRATEGY";
    case UnreachableReason::kHolder:
      return "HOLDER";
    case UnreachableReason::kShank:
      return "SHANK";
    case UnreachableReason::kOutside:
      return "OUTSIDE";
  }
  return "";
}

const char* Name(BorderKind kind) {
  switch (kind) {
    case BorderKind::kOpenEdge:
      return "open edge";
    case BorderKind::kReach:
      return "limit of reach";
    case BorderKind::kSlope:
      return "steep angle";
    case BorderKind::kCurvature:
      return "contours turn";
    case BorderKind::kSilhouette:
      return "upright";
    case BorderKind::kWatershed:
      return "watershed";
    case BorderKind::kSeam:
      return "patch border";
    case BorderKind::kStrategy:
      return "limit of strategy";
  }
  return "";
}

}  // namespace patchmill
