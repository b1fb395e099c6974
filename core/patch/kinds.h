// The functions that each kind of patch implements. patch.h and piece.h dispatch to them. Private to
// core/patch.
//
// Every kind has its own evaluation and its own way to be cut into Bernstein nets [shapes, section 8].
#pragma once

#include <type_traits>
#include <vector>

#include "core/base/run_context.h"
#include "core/math/jet2.h"
#include "core/patch/patch.h"
#include "core/patch/piece.h"

namespace patchmill::internal {

SurfaceJet EvaluateShape(const BezierPatch& patch, double u, double v);
SurfaceJet EvaluateShape(const BsplinePatch& patch, double u, double v);
SurfaceJet EvaluateShape(const GregoryPatch& patch, double u, double v);
SurfaceJet EvaluateShape(const BezierTriangle& patch, double s, double t);
SurfaceJet EvaluateShape(const BrownPatch& patch, double u, double v);
SurfaceJet EvaluateShape(const GregoryTriangle& patch, double s, double t);
SurfaceJet EvaluateShape(const LoftTriangle& patch, double s, double t);
SurfaceJet EvaluateShape(const G2GregoryPatch& patch, double u, double v);
SurfaceJet EvaluateShape(const HosakaPatch& patch, double u, double v);

Vec3 ShapePosition(const BezierPatch& patch, double u, double v);
Vec3 ShapePosition(const BsplinePatch& patch, double u, double v);
Vec3 ShapePosition(const GregoryPatch& patch, double u, double v);
Vec3 ShapePosition(const BezierTriangle& patch, double s, double t);
Vec3 ShapePosition(const BrownPatch& patch, double u, double v);
Vec3 ShapePosition(const GregoryTriangle& patch, double s, double t);
Vec3 ShapePosition(const LoftTriangle& patch, double s, double t);
Vec3 ShapePosition(const G2GregoryPatch& patch, double u, double v);
Vec3 ShapePosition(const HosakaPatch& patch, double u, double v);

// Whether the kind's nets have zero weight at corners. They bound the patch there but do not evaluate it.
template <class Shape>
constexpr bool HasSingularNet(const Shape&) {
  return std::is_same_v<Shape, GregoryPatch> || std::is_same_v<Shape, BrownPatch> ||
         std::is_same_v<Shape, GregoryTriangle> || std::is_same_v<Shape, LoftTriangle> ||
         std::is_same_v<Shape, G2GregoryPatch>;
}

// The pieces, without patch id and without pointers to the patch. Kinds of many pieces poll `run` and, once
// it is cancelled, return the pieces made so far.
std::vector<Piece> ShapePieces(const BezierPatch& patch);
std::vector<Piece> ShapePieces(const BsplinePatch& patch, const RunContext& run);
std::vector<Piece> ShapePieces(const GregoryPatch& patch);
std::vector<Piece> ShapePieces(const BezierTriangle& patch);
std::vector<Piece> ShapePieces(const BrownPatch& patch, const RunContext& run);
std::vector<Piece> ShapePieces(const GregoryTriangle& patch);
std::vector<Piece> ShapePieces(const LoftTriangle& patch);
std::vector<Piece> ShapePieces(const G2GregoryPatch& patch);
std::vector<Piece> ShapePieces(const HosakaPatch& patch);

// Native corners of a piece that covers [u0,u1] x [v0,v1].
inline std::array<Vec2, 4> NativeRectangle(double u0, double u1, double v0, double v1) {
  return {Vec2{u0, v0}, Vec2{u1, v0}, Vec2{u0, v1}, Vec2{u1, v1}};
}

// Within this distance of a singular corner, second derivatives are those of [shapes, section 7].
inline constexpr double kCornerRadius = 1e-6;
// Below this distance the blended terms, which are of second order, count as zero: their ratios would
// overflow.
inline constexpr double kNothing = 1e-90;

// Adds phi * d to the jet, with all derivatives.
inline void AddTerm(const Jet2& phi, const Vec3& d, SurfaceJet& s) {
  s.p += phi.f * d;
  s.du += phi.u * d;
  s.dv += phi.v * d;
  s.duu += phi.uu * d;
  s.duv += phi.uv * d;
  s.dvv += phi.vv * d;
}

}  // namespace patchmill::internal
