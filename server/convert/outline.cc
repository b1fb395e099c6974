#include "server/convert/outline.h"

#include <cmath>

#include <fmt/format.h>

#include "server/convert/enums.h"
#include "server/convert/fields.h"
#include "server/limits.h"

namespace patchmill {
namespace {

std::vector<std::string> ReadNames(const google::protobuf::RepeatedPtrField<std::string>& names,
                                   const std::string& field, FieldErrors& errors) {
  if (names.size() > static_cast<int>(limits::kMaxPatches)) {
    errors.Add(field,
               fmt::format("has {} elements; must have at most {}", names.size(), limits::kMaxPatches));
    return {};
  }
  for (int i = 0; i < names.size(); ++i) {
    RequireBytes(errors, fmt::format("{}[{}]", field, i), names[i], limits::kMaxIdBytes);
  }
  return {names.begin(), names.end()};
}

}  // namespace

Ring ReadRing(const google::protobuf::RepeatedField<double>& xy, const std::string& field,
              std::size_t& points, FieldErrors& errors) {
  const auto count = static_cast<std::size_t>(xy.size());
  points += count / 2;
  if (count % 2 != 0) {
    errors.Add(field, fmt::format("has {} numbers; must be packed x y", count));
    return {};
  }
  if (points > limits::kMaxOutlinePoints) {
    errors.Add(field, fmt::format("brings the outlines to {} points; must be at most {} together", points,
                                  limits::kMaxOutlinePoints));
    return {};
  }
  Ring ring;
  ring.reserve(count / 2);
  for (int i = 0; i + 1 < xy.size(); i += 2) {
    for (int k = i; k < i + 2; ++k) {
      constexpr double kMost = limits::kMaxCoordinateMm;
      if (!Require(errors, fmt::format("{}[{}]", field, k), xy[k], std::abs(xy[k]) <= kMost,
                   fmt::format("in [{}, {}]", -kMost, kMost))) {
        return {};
      }
    }
    ring.emplace_back(xy[i], xy[i + 1]);
  }
  if (const std::string fault = OutlineFault({ring}); !fault.empty()) {
    errors.Add(field, "is no outline: " + fault);
    return {};
  }
  return ring;
}

void WriteRing(const Ring& ring, google::protobuf::RepeatedField<double>* xy) {
  for (const Vec2& p : ring) {
    xy->Add(p.x());
    xy->Add(p.y());
  }
}

Selection FromProto(const v1::Selection& proto, std::string_view at, FieldErrors& errors) {
  Selection s;
  s.patches = ReadNames(proto.patch_ids(), At(at, "patch_ids"), errors);
  s.avoid = ReadNames(proto.avoid_patch_ids(), At(at, "avoid_patch_ids"), errors);
  s.avoid_margin = proto.avoid_margin_mm();
  Require(errors, At(at, "avoid_margin_mm"), s.avoid_margin,
          s.avoid_margin >= 0.0 && s.avoid_margin <= limits::kMaxAvoidMarginMm,
          fmt::format("in [0, {}]", limits::kMaxAvoidMarginMm));
  std::size_t points = 0;
  if (!proto.boundary_xy_mm().empty()) {
    s.boundary.push_back(ReadRing(proto.boundary_xy_mm(), At(at, "boundary_xy_mm"), points, errors));
  }
  for (int i = 0; i < proto.more_boundary_rings_size(); ++i) {
    const std::string field = fmt::format("{}[{}].xy_mm", At(at, "more_boundary_rings"), i);
    s.boundary.push_back(ReadRing(proto.more_boundary_rings(i).xy_mm(), field, points, errors));
  }
  s.mill_outside = proto.mill_outside();
  s.boundary_mode = FromProto(proto.boundary_mode(), At(at, "boundary_mode"), errors);
  s.boundary_offset = proto.boundary_offset_mm();
  constexpr double kMost = limits::kMaxOutlineOffsetMm;
  Require(errors, At(at, "boundary_offset_mm"), s.boundary_offset, std::abs(s.boundary_offset) <= kMost,
          fmt::format("in [{}, {}]", -kMost, kMost));
  return s;
}

v1::Selection ToProto(const Selection& selection) {
  v1::Selection proto;
  for (const std::string& name : selection.patches) proto.add_patch_ids(Utf8(name));
  for (const std::string& name : selection.avoid) proto.add_avoid_patch_ids(Utf8(name));
  proto.set_avoid_margin_mm(selection.avoid_margin);
  proto.set_mill_outside(selection.mill_outside);
  if (selection.boundary.empty()) return proto;
  WriteRing(selection.boundary.front(), proto.mutable_boundary_xy_mm());
  for (std::size_t i = 1; i < selection.boundary.size(); ++i) {
    WriteRing(selection.boundary[i], proto.add_more_boundary_rings()->mutable_xy_mm());
  }
  proto.set_boundary_mode(ToProto(selection.boundary_mode));
  proto.set_boundary_offset_mm(selection.boundary_offset);
  return proto;
}

}  // namespace patchmill
