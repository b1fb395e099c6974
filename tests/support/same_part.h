// One part given in many ways: moved, cut into patches, in another order, with other parameters.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/patch/piece.h"
#include "tests/support/shapes.h"

namespace patchmill::testing {

// Every patch cut into its Bernstein rectangles, each a Bezier patch of its own.
inline PatchModel AsBezierPatches(const PatchModel& model) {
  PatchModel cut;
  for (std::size_t k = 0; k < model.patches.size(); ++k) {
    for (const Piece& piece : SplitIntoPieces(PatchId(k), model.patches[k].shape)) {
      BezierPatch patch;
      patch.degree_u = piece.net.degree_u;
      patch.degree_v = piece.net.degree_v;
      for (const Vec4& p : piece.net.points) {
        patch.points.push_back(p.head<3>() / p.w());
        if (piece.net.rational) patch.weights.push_back(p.w());
      }
      cut.patches.push_back({"", std::move(patch)});
    }
  }
  return cut;
}

inline PatchModel Reordered(PatchModel model) {
  std::reverse(model.patches.begin(), model.patches.end());
  std::rotate(model.patches.begin(),
              model.patches.begin() + static_cast<std::ptrdiff_t>(model.patches.size() / 3),
              model.patches.end());
  return model;
}

// Point (i,j) of a Bezier patch goes to (j,i), then both directions are turned
// round as asked.
inline PatchModel Reparametrised(PatchModel model, bool swap, bool reverse_u, bool reverse_v) {
  for (Patch& patch : model.patches) {
    auto& given = std::get<BezierPatch>(patch.shape);
    BezierPatch made;
    made.degree_u = swap ? given.degree_v : given.degree_u;
    made.degree_v = swap ? given.degree_u : given.degree_v;
    for (int i = 0; i <= made.degree_u; ++i) {
      for (int j = 0; j <= made.degree_v; ++j) {
        const int a = reverse_u ? made.degree_u - i : i, b = reverse_v ? made.degree_v - j : j;
        const auto from =
            static_cast<std::size_t>(swap ? b * (given.degree_v + 1) + a : a * (given.degree_v + 1) + b);
        made.points.push_back(given.points[from]);
        if (!given.weights.empty()) made.weights.push_back(given.weights[from]);
      }
    }
    given = std::move(made);
  }
  return model;
}

struct SamePart {
  std::string name;
  PatchModel model;
  Vec3 shift = Vec3::Zero();  // of the part against the first one
};

inline std::vector<SamePart> ManyWays(const PatchModel& model) {
  const Vec3 shift(13.7, -21.3, 8.9);
  const PatchModel cut = AsBezierPatches(model);
  return {{"as given", model},
          {"shifted", Transformed(model, Eigen::Affine3d(Eigen::Translation3d(shift))), shift},
          {"as Bezier patches", cut},
          {"in another order", Reordered(cut)},
          {"u and v swapped", Reparametrised(cut, true, false, false)},
          {"reversed", Reparametrised(cut, false, true, true)},
          {"mirrored parameters", Reparametrised(Reordered(cut), true, true, false)}};
}

}  // namespace patchmill::testing
