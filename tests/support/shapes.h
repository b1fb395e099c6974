// Analytic models for tests. All lengths mm, angles rad, z up. Normals S_u x S_v point up or outward.
//
// What is called exact has the stated surface to rounding error; the splines interpolate.
#pragma once

#include <cstdint>
#include <functional>

#include "core/network/patch_model.h"

namespace patchmill::testing {

PatchModel Single(PatchShape shape);
PatchModel Join(std::initializer_list<PatchModel> models);  // all patches, in order
PatchModel Transformed(PatchModel model, const Eigen::Affine3d& motion);

// --- Flat, exact (bilinear patches) ---
// corners in the order (0,0) (1,0) (0,1) (1,1) of u, v
PatchShape Bilinear(const Vec3& p00, const Vec3& p10, const Vec3& p01, const Vec3& p11);
// z = z0 + slope_x x + slope_y y over [-half,half]^2; slopes are tangents.
PatchModel Plane(double half, double z0 = 0, double slope_x = 0, double slope_y = 0);
// z = |x| tan(angle) over [-half,half]^2: a valley for angle > 0, a ridge for angle < 0. Two patches.
PatchModel TwoPlanes(double angle, double half);
// Block |x|,|y| <= block_half, 0 <= z <= height with vertical walls, standing on a floor z = 0 up to
// floor_half; its footprint is not part of the floor. 13 patches: 8 floor, 4 walls, 1 top.
PatchModel Block(double block_half, double height, double floor_half);

// --- Of revolution, exact (rational biquadratic patches) ---
enum class Half { kUpper, kAll };
// Octants with a degenerate edge at the poles (v = 1 at the north, v = 0 at the south): 4 or 8 patches.
PatchModel Sphere(const Vec3& center, double radius, Half half = Half::kAll);
// Axis along y through `center`, y within +- half_length; no end caps: 2 or 4 patches.
PatchModel Cylinder(const Vec3& center, double radius, double half_length, Half half = Half::kAll);
// Axis along z through `center`; radius of the circle of tube centres, radius of the tube: 8 or 16 patches.
PatchModel Torus(const Vec3& center, double major, double minor, Half half = Half::kAll);
// Upper halves of two spheres at (-distance/2,0,0) and (distance/2,0,0).
PatchModel TwoSpheres(double radius, double distance);

// --- Quadratic height fields over [-half,half]^2, exact (one biquadratic patch) ---
PatchModel Quadratic(double a, double b, double half);  // z = a x^2 + b y^2, a and b in 1/mm
PatchModel Saddle(double a, double b, double half);     // z = a x^2 - b y^2
PatchModel Paraboloid(double a, double half);           // z = a (x^2 + y^2)
PatchModel ParabolicValley(double a, double half);      // z = a x^2

// --- Splines ---
using HeightFunction = std::function<double(double x, double y)>;
// Bicubic B-spline over [x0,x1] x [y0,y1] with equal spans, at least 3 each way, equal to f at all knots;
// clamped, not-a-knot ends. u along x, v along y, both linear.
BsplinePatch InterpolatedHeights(const HeightFunction& f, double x0, double x1, double y0, double y1,
                                 int spans_x, int spans_y);
double TwoHillsHeight(double x, double y);  // tests/bench/README.md
double BumpyHeight(double x, double y);     // tests/bench/README.md
PatchModel TwoHills();                      // 32 x 32 spans on [0,100]^2
PatchModel Bumpy();                         // 50 x 50 spans on [0,100]^2

// A random bicubic height field over [0,size]^2; the same for the same arguments everywhere.
struct RandomBsplineParams {
  int spans = 6;           // each way
  double size = 40.0;      // mm
  double amplitude = 4.0;  // mm: control heights in [-amplitude, amplitude)
  bool folds = false;      // control points also wander sideways, by up to 1.5 steps: overhangs, folds
  bool rational = false;   // weights in [0.5, 2)
};
PatchModel RandomBspline(std::uint64_t seed, const RandomBsplineParams& params = {});

// --- Single patches of every kind, random, over about [0,size]^2 in the plan; weights in [0.5,2) or none ---
BezierPatch RandomBezier(std::uint64_t seed, int degree_u, int degree_v, bool rational, double size = 20.0);
// Five spans each way, uneven, an inner knot of full multiplicity (a crease); clamped along u, not along v.
BsplinePatch RandomKnots(std::uint64_t seed, int degree_u, int degree_v, bool rational, double size = 20.0);
// Gregory points depend on the seed only, not on the blend.
GregoryPatch RandomGregory(std::uint64_t seed, GregoryPatch::Blend blend, double size = 20.0);
// Over the plan triangle (0,0) (size,0) (0,size).
BezierTriangle RandomTriangle(std::uint64_t seed, int degree, bool rational, double size = 20.0);
// With breaks its chains have continuous derivatives there.
BrownPatch RandomBrown(std::uint64_t seed, int degree_u, int degree_v, double size = 20.0,
                       const std::vector<double>& breaks_u = {}, const std::vector<double>& breaks_v = {});
GregoryTriangle RandomGregoryTriangle(std::uint64_t seed, GregoryPatch::Blend blend, double size = 20.0);
LoftTriangle RandomLoftTriangle(std::uint64_t seed, int degree, bool squared, double size = 20.0);
G2GregoryPatch RandomG2Gregory(std::uint64_t seed, int degree, double size = 20.0);
// With breaks, f1 has one and f4 two; with an inner term, 2 x 3 coefficients of order 2.
HosakaPatch RandomHosaka(std::uint64_t seed, int degree, bool breaks, bool inner, double size = 20.0);
// One of every kind that may have bulges, with three of them.
std::vector<PatchShape> BulgedKinds(double size = 20.0);
// One of every kind whose net has singular corners.
std::vector<PatchShape> SingularKinds(double size = 20.0);

}  // namespace patchmill::testing
