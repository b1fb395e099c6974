// Values of Open CASCADE as ours.
#pragma once

#include <gp_Ax3.hxx>
#include <gp_Dir.hxx>
#include <gp_Pnt.hxx>
#include <gp_Pnt2d.hxx>
#include <gp_XYZ.hxx>

#include "core/base/vec.h"
#include "core/brep/brep_model.h"

namespace patchmill {

inline Vec3 ToVec3(const gp_XYZ& p) { return {p.X(), p.Y(), p.Z()}; }
inline Vec3 ToVec3(const gp_Pnt& p) { return ToVec3(p.XYZ()); }
inline Vec3 ToVec3(const gp_Dir& d) { return ToVec3(d.XYZ()); }
inline Vec2 ToVec2(const gp_Pnt2d& p) { return {p.X(), p.Y()}; }
inline gp_Pnt ToPnt(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

// Left-handed frames stay left-handed.
inline BrepFrame ToFrame(const gp_Ax3& a) {
  return {ToVec3(a.Location()), ToVec3(a.XDirection()), ToVec3(a.YDirection()), ToVec3(a.Direction())};
}

}  // namespace patchmill
