// What each kind of patch implements; patch.h and piece.h dispatch to it. Private to core/patch.
//
// Every kind has its native evaluation and its cutting into Bernstein nets (ALGORITHMS 1).
#pragma once

#include <vector>

#include "core/patch/patch.h"
#include "core/patch/piece.h"

namespace patchmill::internal {

SurfaceJet EvaluateShape(const BezierPatch& patch, double u, double v);
SurfaceJet EvaluateShape(const BsplinePatch& patch, double u, double v);
SurfaceJet EvaluateShape(const GregoryPatch& patch, double u, double v);
SurfaceJet EvaluateShape(const BezierTriangle& patch, double s, double t);

Vec3 ShapePosition(const BezierPatch& patch, double u, double v);
Vec3 ShapePosition(const BsplinePatch& patch, double u, double v);
Vec3 ShapePosition(const GregoryPatch& patch, double u, double v);
Vec3 ShapePosition(const BezierTriangle& patch, double s, double t);

// Without the patch id.
std::vector<Piece> ShapePieces(const BezierPatch& patch);
std::vector<Piece> ShapePieces(const BsplinePatch& patch);
std::vector<Piece> ShapePieces(const GregoryPatch& patch);
std::vector<Piece> ShapePieces(const BezierTriangle& patch);

// Native corners of a piece that covers [u0,u1] x [v0,v1].
inline std::array<Vec2, 4> NativeRectangle(double u0, double u1, double v0, double v1) {
  return {Vec2{u0, v0}, Vec2{u1, v0}, Vec2{u0, v1}, Vec2{u1, v1}};
}

}  // namespace patchmill::internal
