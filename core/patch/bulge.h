// The displacement of a patch by its bulges [shapes, section 12].
#pragma once

#include <vector>

#include "core/math/jet2.h"
#include "core/math/tensor_bernstein.h"
#include "core/patch/piece.h"

namespace patchmill {

// The weight of a bulge at (at_u, at_v): 1 there, its only maximum, and 0 on the border with its first and
// second derivatives. Second derivatives are continuous.
Jet2 BulgeWeight(double at_u, double at_v, double u, double v);

namespace internal {

// Adds the bulges to the jet of a patch at (u, v).
void AddBulges(const std::vector<Bulge>& bulges, double u, double v, SurfaceJet& s);

// The net of the denominators by which the pieces of a kind were multiplied, as one net of the whole patch.
ScaledBernstein<double> NetWeight(const GregoryPatch& patch);
ScaledBernstein<double> NetWeight(const BrownPatch& patch);
ScaledBernstein<double> NetWeight(const G2GregoryPatch& patch);
ScaledBernstein<double> NetWeight(const HosakaPatch& patch);

// The pieces with the bulges, exact. They are cut at the places of the bulges. `weight`: NetWeight. Cost:
// O(bulges) for each piece.
std::vector<Piece> WithBulges(const std::vector<Piece>& pieces, const std::vector<Bulge>& bulges,
                              const ScaledBernstein<double>& weight);

}  // namespace internal
}  // namespace patchmill
