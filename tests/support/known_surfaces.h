// Known surfaces as networks of G2-Gregory faces: what joining makes of their curves is measured against
// them. The list was fixed before the rule for the middles of edges was written.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/joining/curve_network.h"
#include "core/joining/join_network.h"

namespace patchmill::testing {

using KnownSurface = std::function<Vec3(double, double)>;

// A surface and a network on it. Face f covers a part of the parameters; `corners` are those of its vertices.
struct KnownNetwork {
  std::string name;
  KnownSurface surface;
  CurveNetwork network;
  std::vector<std::array<Vec2, 4>> corners;
};

// A surface over a grid of parameters. The edges are the cubic splines, over these parameters, through the
// vertices of a row or a column, with the true derivatives at both ends. A bicubic surface has exact edges.
KnownNetwork KnownGrid(std::string name, KnownSurface surface, const std::vector<double>& us,
                       const std::vector<double>& vs);

// A random bicubic surface of about 100 x 100 mm over the unit square: a plane grid of Bezier points, moved
// by up to `move` in each coordinate.
KnownSurface RandomBicubic(unsigned seed, double move);

// u (u - 1/2) (u - 1) v (v - 1/2) (v - 1): it vanishes on all edges of 2 x 2 equal faces. So their curves
// do not tell how much of it a bicubic surface has. WithoutHiddenPart takes so much of it away that u^3 v^3
// is gone.
double HiddenPart(double u, double v);
KnownSurface WithoutHiddenPart(const KnownSurface& bicubic);

// `sectors` quads around a vertex on z = height(x, y) and two rings of faces about them. Spokes and rings are
// splines in the chord parameter.
KnownNetwork KnownStar(std::string name, int sectors);

// Two by two faces of a bicubic surface without hidden part; then the twenty surfaces of the list.
KnownNetwork KnownBicubic();
std::vector<KnownNetwork> KnownSurfaces();

// The control that prescribes the mean vectors of both ends of a face's side. `joined` has the edges.
CrossControl MeanControl(const CurveNetwork& network, const JoinedNetwork& joined, const FaceSide& side);

// The network with all controls prescribed. WithMeans: those that joining took before it estimated them, the
// means of the vectors at both ends of an edge, laid into one direction and given one bend. WithTruth: the
// derivatives of the surface itself. Only for grids.
CurveNetwork WithMeans(const KnownNetwork& known);
CurveNetwork WithTruth(const KnownNetwork& known);

// The largest distance (mm) of the patches from the surface, over samples x samples places of each.
double LargestError(const KnownNetwork& known, const JoinedNetwork& joined, int samples = 9);

}  // namespace patchmill::testing
