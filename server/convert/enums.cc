#include "server/convert/enums.h"

#include <fmt/format.h>

namespace patchmill {
namespace {

void Unknown(int value, const std::string& field, FieldErrors& errors) {
  errors.Add(field, fmt::format("= {}; this server does not know that value", value));
}

}  // namespace

UpAxis FromProto(v1::UpAxis value, const std::string& field, FieldErrors& errors) {
  switch (value) {
    case v1::UP_AXIS_UNSPECIFIED:
    case v1::UP_AXIS_Z:
      return UpAxis::kZ;
    case v1::UP_AXIS_Y:
      return UpAxis::kY;
    case v1::UP_AXIS_X:
      return UpAxis::kX;
    case v1::UP_AXIS_NEG_Z:
      return UpAxis::kNegZ;
    case v1::UP_AXIS_NEG_Y:
      return UpAxis::kNegY;
    case v1::UP_AXIS_NEG_X:
      return UpAxis::kNegX;
    default:
      Unknown(value, field, errors);
      return UpAxis::kZ;
  }
}

Setup::Zero FromProto(v1::ZeroAnchor value, const std::string& field, FieldErrors& errors) {
  switch (value) {
    case v1::ZERO_ANCHOR_UNSPECIFIED:
    case v1::ZERO_ANCHOR_ORIGIN:
      return Setup::Zero::kPoint;
    case v1::ZERO_ANCHOR_TOP_CENTER:
      return Setup::Zero::kTopCenter;
    case v1::ZERO_ANCHOR_BOTTOM_CORNER:
      return Setup::Zero::kBottomCorner;
    default:
      Unknown(value, field, errors);
      return Setup::Zero::kPoint;
  }
}

Coolant FromProto(v1::Coolant value, const std::string& field, FieldErrors& errors) {
  switch (value) {
    case v1::COOLANT_UNSPECIFIED:
    case v1::COOLANT_OFF:
      return Coolant::kOff;
    case v1::COOLANT_FLOOD:
      return Coolant::kFlood;
    case v1::COOLANT_MIST:
      return Coolant::kMist;
    case v1::COOLANT_AIR:
      return Coolant::kAir;
    default:
      Unknown(value, field, errors);
      return Coolant::kOff;
  }
}

Strategy FromProto(v1::Strategy value, const std::string& field, FieldErrors& errors) {
  switch (value) {
    case v1::STRATEGY_UNSPECIFIED:
    case v1::STRATEGY_AUTO:
      return Strategy::kAuto;
    case v1::STRATEGY_CONTOUR:
      return Strategy::kContour;
    case v1::STRATEGY_ZIGZAG:
      return Strategy::kZigzag;
    default:
      Unknown(value, field, errors);
      return Strategy::kAuto;
  }
}

CutDirection FromProto(v1::CutDirection value, const std::string& field, FieldErrors& errors) {
  switch (value) {
    case v1::CUT_DIRECTION_UNSPECIFIED:
    case v1::CUT_DIRECTION_CLIMB:
      return CutDirection::kClimb;
    case v1::CUT_DIRECTION_CONVENTIONAL:
      return CutDirection::kConventional;
    case v1::CUT_DIRECTION_EITHER:
      return CutDirection::kEither;
    default:
      Unknown(value, field, errors);
      return CutDirection::kClimb;
  }
}

BoundaryMode FromProto(v1::BoundaryMode value, const std::string& field, FieldErrors& errors) {
  switch (value) {
    case v1::BOUNDARY_MODE_UNSPECIFIED:
    case v1::BOUNDARY_MODE_CENTER:
      return BoundaryMode::kCenter;
    case v1::BOUNDARY_MODE_CONTACT:
      return BoundaryMode::kContact;
    case v1::BOUNDARY_MODE_INSIDE:
      return BoundaryMode::kInside;
    case v1::BOUNDARY_MODE_OUTSIDE:
      return BoundaryMode::kOutside;
    default:
      Unknown(value, field, errors);
      return BoundaryMode::kCenter;
  }
}

EdgeRule FromProto(v1::EdgeRule value, const std::string& field, FieldErrors& errors) {
  switch (value) {
    case v1::EDGE_RULE_UNSPECIFIED:
    case v1::EDGE_RULE_STOP:
      return EdgeRule::kStop;
    case v1::EDGE_RULE_ROLL:
      return EdgeRule::kRoll;
    case v1::EDGE_RULE_EXTEND:
      return EdgeRule::kExtend;
    default:
      Unknown(value, field, errors);
      return EdgeRule::kStop;
  }
}

v1::UpAxis ToProto(UpAxis value) {
  switch (value) {
    case UpAxis::kZ:
      return v1::UP_AXIS_Z;
    case UpAxis::kY:
      return v1::UP_AXIS_Y;
    case UpAxis::kX:
      return v1::UP_AXIS_X;
    case UpAxis::kNegZ:
      return v1::UP_AXIS_NEG_Z;
    case UpAxis::kNegY:
      return v1::UP_AXIS_NEG_Y;
    case UpAxis::kNegX:
      return v1::UP_AXIS_NEG_X;
  }
  return v1::UP_AXIS_UNSPECIFIED;
}

v1::ZeroAnchor ToProto(Setup::Zero value) {
  switch (value) {
    case Setup::Zero::kPoint:
      return v1::ZERO_ANCHOR_ORIGIN;
    case Setup::Zero::kTopCenter:
      return v1::ZERO_ANCHOR_TOP_CENTER;
    case Setup::Zero::kBottomCorner:
      return v1::ZERO_ANCHOR_BOTTOM_CORNER;
  }
  return v1::ZERO_ANCHOR_UNSPECIFIED;
}

v1::Coolant ToProto(Coolant value) {
  switch (value) {
    case Coolant::kOff:
      return v1::COOLANT_OFF;
    case Coolant::kFlood:
      return v1::COOLANT_FLOOD;
    case Coolant::kMist:
      return v1::COOLANT_MIST;
    case Coolant::kAir:
      return v1::COOLANT_AIR;
  }
  return v1::COOLANT_UNSPECIFIED;
}

v1::Strategy ToProto(Strategy value) {
  switch (value) {
    case Strategy::kAuto:
      return v1::STRATEGY_AUTO;
    case Strategy::kContour:
      return v1::STRATEGY_CONTOUR;
    case Strategy::kZigzag:
      return v1::STRATEGY_ZIGZAG;
  }
  return v1::STRATEGY_UNSPECIFIED;
}

v1::CutDirection ToProto(CutDirection value) {
  switch (value) {
    case CutDirection::kClimb:
      return v1::CUT_DIRECTION_CLIMB;
    case CutDirection::kConventional:
      return v1::CUT_DIRECTION_CONVENTIONAL;
    case CutDirection::kEither:
      return v1::CUT_DIRECTION_EITHER;
  }
  return v1::CUT_DIRECTION_UNSPECIFIED;
}

v1::BoundaryMode ToProto(BoundaryMode value) {
  switch (value) {
    case BoundaryMode::kContact:
      return v1::BOUNDARY_MODE_CONTACT;
    case BoundaryMode::kCenter:
      return v1::BOUNDARY_MODE_CENTER;
    case BoundaryMode::kInside:
      return v1::BOUNDARY_MODE_INSIDE;
    case BoundaryMode::kOutside:
      return v1::BOUNDARY_MODE_OUTSIDE;
  }
  return v1::BOUNDARY_MODE_UNSPECIFIED;
}

v1::EdgeRule ToProto(EdgeRule value) {
  switch (value) {
    case EdgeRule::kStop:
      return v1::EDGE_RULE_STOP;
    case EdgeRule::kRoll:
      return v1::EDGE_RULE_ROLL;
    case EdgeRule::kExtend:
      return v1::EDGE_RULE_EXTEND;
  }
  return v1::EDGE_RULE_UNSPECIFIED;
}

v1::MoveKind ToProto(MoveKind value) {
  switch (value) {
    case MoveKind::kRapid:
      return v1::MOVE_KIND_RAPID;
    case MoveKind::kApproach:
      return v1::MOVE_KIND_APPROACH;
    case MoveKind::kPlunge:
      return v1::MOVE_KIND_PLUNGE;
    case MoveKind::kLead:
      return v1::MOVE_KIND_LEAD;
    case MoveKind::kCut:
      return v1::MOVE_KIND_CUT;
    case MoveKind::kLink:
      return v1::MOVE_KIND_LINK;
    case MoveKind::kRetract:
      return v1::MOVE_KIND_RETRACT;
  }
  return v1::MOVE_KIND_UNSPECIFIED;
}

v1::ArcPlane ToProto(ArcPlane value) {
  switch (value) {
    case ArcPlane::kXy:
      return v1::ARC_PLANE_XY;
    case ArcPlane::kZx:
      return v1::ARC_PLANE_ZX;
    case ArcPlane::kYz:
      return v1::ARC_PLANE_YZ;
  }
  return v1::ARC_PLANE_UNSPECIFIED;
}

v1::BorderKind ToProto(BorderKind value) {
  switch (value) {
    case BorderKind::kOpenEdge:
      return v1::BORDER_KIND_OPEN_EDGE;
    case BorderKind::kReach:
      return v1::BORDER_KIND_REACH;
    case BorderKind::kSlope:
      return v1::BORDER_KIND_SLOPE;
    case BorderKind::kCurvature:
      return v1::BORDER_KIND_CURVATURE;
    case BorderKind::kSilhouette:
      return v1::BORDER_KIND_SILHOUETTE;
    case BorderKind::kWatershed:
      return v1::BORDER_KIND_WATERSHED;
    case BorderKind::kSeam:
      return v1::BORDER_KIND_SEAM;
    case BorderKind::kStrategy:
      return v1::BORDER_KIND_STRATEGY;
  }
  return v1::BORDER_KIND_UNSPECIFIED;
}

v1::RegionKind ToProto(RegionKind value) {
  switch (value) {
    case RegionKind::kMountain:
      return v1::REGION_KIND_MOUNTAIN;
    case RegionKind::kBasin:
      return v1::REGION_KIND_BASIN;
    case RegionKind::kNeutral:
      return v1::REGION_KIND_NEUTRAL;
    case RegionKind::kUnreachable:
      return v1::REGION_KIND_UNREACHABLE;
  }
  return v1::REGION_KIND_UNSPECIFIED;
}

v1::Slope ToProto(SlopeClass value) {
  switch (value) {
    case SlopeClass::kUnspecified:
      return v1::SLOPE_UNSPECIFIED;
    case SlopeClass::kSteep:
      return v1::SLOPE_STEEP;
    case SlopeClass::kGentle:
      return v1::SLOPE_GENTLE;
  }
  return v1::SLOPE_UNSPECIFIED;
}

v1::UnreachableReason ToProto(UnreachableReason value) {
  switch (value) {
    case UnreachableReason::kNone:
      return v1::UNREACHABLE_REASON_UNSPECIFIED;
    case UnreachableReason::kUndercut:
      return v1::UNREACHABLE_REASON_UNDERCUT;
    case UnreachableReason::kConcave:
      return v1::UNREACHABLE_REASON_CONCAVE;
    case UnreachableReason::kFloor:
      return v1::UNREACHABLE_REASON_FLOOR;
    case UnreachableReason::kAvoided:
      return v1::UNREACHABLE_REASON_AVOIDED;
    case UnreachableReason::kStrategy:
      return v1::UNREACHABLE_REASON_STRATEGY;
    case UnreachableReason::kHolder:
      return v1::UNREACHABLE_REASON_HOLDER;
    case UnreachableReason::kShank:
      return v1::UNREACHABLE_REASON_SHANK;
    case UnreachableReason::kOutside:
      return v1::UNREACHABLE_REASON_OUTSIDE;
  }
  return v1::UNREACHABLE_REASON_UNSPECIFIED;
}

v1::UnreachableReason ToProto(UncutReason value) {
  switch (value) {
    case UncutReason::kUndercut:
      return v1::UNREACHABLE_REASON_UNDERCUT;
    case UncutReason::kConcave:
      return v1::UNREACHABLE_REASON_CONCAVE;
    case UncutReason::kFloor:
      return v1::UNREACHABLE_REASON_FLOOR;
    case UncutReason::kAvoided:
      return v1::UNREACHABLE_REASON_AVOIDED;
    case UncutReason::kStrategy:
      return v1::UNREACHABLE_REASON_STRATEGY;
    case UncutReason::kHolder:
      return v1::UNREACHABLE_REASON_HOLDER;
    case UncutReason::kShank:
      return v1::UNREACHABLE_REASON_SHANK;
    case UncutReason::kOutside:
      return v1::UNREACHABLE_REASON_OUTSIDE;
  }
  return v1::UNREACHABLE_REASON_UNSPECIFIED;
}

v1::Severity ToProto(Severity value) {
  switch (value) {
    case Severity::kInfo:
      return v1::SEVERITY_INFO;
    case Severity::kWarning:
      return v1::SEVERITY_WARNING;
    case Severity::kError:
      return v1::SEVERITY_ERROR;
  }
  return v1::SEVERITY_UNSPECIFIED;
}

v1::Outcome ToProto(Outcome value) {
  switch (value) {
    case Outcome::kComplete:
      return v1::OUTCOME_COMPLETE;
    case Outcome::kCompleteWhereReachable:
      return v1::OUTCOME_COMPLETE_WHERE_REACHABLE;
    case Outcome::kNothingToCut:
      return v1::OUTCOME_NOTHING_TO_CUT;
    case Outcome::kVerificationFailed:
      return v1::OUTCOME_VERIFICATION_FAILED;
    case Outcome::kNeedsRoughing:
      return v1::OUTCOME_NEEDS_ROUGHING;
    case Outcome::kTooMuchUnreached:
      return v1::OUTCOME_TOO_MUCH_UNREACHED;
  }
  return v1::OUTCOME_UNSPECIFIED;
}

}  // namespace patchmill
