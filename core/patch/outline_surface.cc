#include "core/patch/outline_surface.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "core/base/error_details.h"
#include "core/base/status.h"
#include "core/curve/bezier_chain.h"
#include "core/curve/spline.h"

namespace patchmill {
namespace {

constexpr int kMaxHosakaDegree = 11;

constexpr char kCurves[] = "curves";

std::string At(std::size_t number) { return fmt::format("{}[{}]", kCurves, number); }

absl::StatusOr<BezierChain> FiniteChain(const Curve& curve, std::size_t number) {
  const auto chain = ChainOf(curve);
  if (!chain.ok())
    return FieldError(At(number), fmt::format("is none: {}", std::string(chain.status().message())));
  if (!std::ranges::all_of(chain->points, [](const Vec3& p) { return p.allFinite(); })) {
    return FieldError(At(number), "has a number that is not finite");
  }
  return *chain;
}

absl::Status Alike(std::vector<BezierChain>& chains) {
  const absl::Status status = MakeAlike(chains);
  return status.ok()
             ? status
             : FieldError(kCurves, fmt::format("cannot be made alike: {}", std::string(status.message())));
}

absl::Status TooLarge(std::size_t points) {
  return FieldError(kCurves, fmt::format("make a surface of {} control points; must be at most {}", points,
                                         kMaxOutlinePoints));
}

// The chains of an outline, with common corners. Opposite chains are made alike.
absl::StatusOr<std::array<BezierChain, 4>> ChainsOf(const BoundaryCurves& outline) {
  std::array<BezierChain, 4> chains;
  for (std::size_t k = 0; k < 4; ++k) {
    PM_ASSIGN_OR_RETURN(chains[k], FiniteChain(outline[k], k));
  }
  auto &bottom = chains[0].points, &right = chains[1].points, &top = chains[2].points,
       &left = chains[3].points;
  struct Corner {
    Vec3 *a, *b;
    const char* name;
  };
  const Corner corners[4] = {{&bottom.front(), &left.front(), "u=0, v=0"},
                             {&bottom.back(), &right.front(), "u=1, v=0"},
                             {&top.back(), &right.back(), "u=1, v=1"},
                             {&top.front(), &left.back(), "u=0, v=1"}};
  Box3 box;
  for (const Corner& corner : corners) box.Add(*corner.a), box.Add(*corner.b);
  for (const Corner& corner : corners) {
    const double gap = (*corner.a - *corner.b).norm();
    if (!(gap <= kMaxCornerGap * box.Diagonal())) {
      return FieldError(kCurves, fmt::format("end {:g} apart at the corner {}; must be at most {:g} of the "
                                             "diagonal {:g}",
                                             gap, corner.name, kMaxCornerGap, box.Diagonal()));
    }
    *corner.a = *corner.b = 0.5 * (*corner.a + *corner.b);
  }
  for (const std::size_t k : {0, 1}) {
    std::vector<BezierChain> pair = {chains[k], chains[k + 2]};
    PM_RETURN_IF_ERROR(Alike(pair));
    chains[k] = std::move(pair[0]), chains[k + 2] = std::move(pair[1]);
  }
  const std::size_t size = chains[0].points.size() * chains[1].points.size();
  if (size > kMaxOutlinePoints) return TooLarge(size);
  return chains;
}

}  // namespace

absl::StatusOr<BsplinePatch> SkinSurface(const std::vector<Curve>& sections) {
  const std::size_t count = sections.size();
  if (count < 3 || count > kMaxSections) {
    return FieldError(kCurves, fmt::format("are {}; must be 3 to {}", count, kMaxSections));
  }
  std::vector<BezierChain> chains;
  for (std::size_t k = 0; k < count; ++k) {
    PM_ASSIGN_OR_RETURN(BezierChain chain, FiniteChain(sections[k], k));
    chains.push_back(std::move(chain));
  }
  if (const std::size_t size = AlikeSize(chains) * (3 * count - 2); size > kMaxOutlinePoints)
    return TooLarge(size);
  PM_RETURN_IF_ERROR(Alike(chains));

  const std::size_t columns = chains[0].points.size();
  std::vector<double> chords(count - 1, 0.0);
  for (std::size_t k = 0; k + 1 < count; ++k) {
    for (std::size_t i = 0; i < columns; ++i)
      chords[k] += (chains[k + 1].points[i] - chains[k].points[i]).norm();
    if (!(chords[k] > 0.0)) {
      return FieldError(At(k + 1), "is the same curve as the one before");
    }
  }
  BezierChain across;  // breaks only
  across.degree = 3;
  double total = 0.0;
  for (const double c : chords) total += c;
  across.breaks = {0.0};
  for (const double c : chords) across.breaks.push_back(across.breaks.back() + c / total);
  across.breaks.back() = 1.0;

  BsplinePatch patch;
  patch.degree_u = chains[0].degree;
  patch.degree_v = 3;
  patch.knots_u = ChainKnots(chains[0]);
  patch.knots_v = ChainKnots(across);
  for (std::size_t i = 0; i < columns; ++i) {
    std::vector<Vec3> column;
    for (const BezierChain& chain : chains) column.push_back(chain.points[i]);
    const std::vector<HermiteCurve> spline = SplineOver(column, chords);
    patch.points.push_back(column.front());
    for (const HermiteCurve& span : spline) {
      const BezierCurve bezier = ToBezier(span);
      patch.points.insert(patch.points.end(), bezier.points.begin() + 1, bezier.points.end());
    }
  }
  return patch;
}

absl::StatusOr<BsplinePatch> CoonsSurface(const BoundaryCurves& outline) {
  PM_ASSIGN_OR_RETURN(const auto chains, ChainsOf(outline));
  const auto &bottom = chains[0].points, &right = chains[1].points, &top = chains[2].points,
             &left = chains[3].points;
  const std::vector<double> us = ControlAbscissae(chains[0]), vs = ControlAbscissae(chains[1]);
  BsplinePatch patch;
  patch.degree_u = chains[0].degree;
  patch.degree_v = chains[1].degree;
  patch.knots_u = ChainKnots(chains[0]);
  patch.knots_v = ChainKnots(chains[1]);
  for (std::size_t i = 0; i < us.size(); ++i) {
    for (std::size_t j = 0; j < vs.size(); ++j) {
      const double u = us[i], v = vs[j];
      const Vec3 corners = (1 - u) * ((1 - v) * bottom.front() + v * top.front()) +
                           u * ((1 - v) * bottom.back() + v * top.back());
      Vec3 point = (1 - v) * bottom[i] + v * top[i] + (1 - u) * left[j] + u * right[j] - corners;
      if (i == 0) point = left[j];
      if (i + 1 == us.size()) point = right[j];
      if (j == 0) point = bottom[i];
      if (j + 1 == vs.size()) point = top[i];
      patch.points.push_back(point);
    }
  }
  return patch;
}

absl::StatusOr<HosakaPatch> HosakaSurface(const BoundaryCurves& outline) {
  PM_ASSIGN_OR_RETURN(const auto chains, ChainsOf(outline));
  int degree = 1;
  for (std::size_t k = 0; k < 4; ++k) {
    if (chains[k].spans() > 1) {
      return FieldError(At(k), fmt::format("has {} spans; Hosaka's surface takes one, a Coons surface any",
                                           chains[k].spans()));
    }
    degree = std::max(degree, chains[k].degree);
  }
  if (degree > kMaxHosakaDegree) {
    return FieldError(kCurves,
                      fmt::format("have one of degree {}; must be at most {}", degree, kMaxHosakaDegree));
  }
  HosakaPatch patch;
  patch.degree = degree;
  const auto raised = [&](std::size_t k) { return Elevated(BezierCurve{chains[k].points}, degree).points; };
  for (const std::size_t k : {0, 2}) {
    const std::vector<Vec3> edge = raised(k);
    patch.points.insert(patch.points.end(), edge.begin(), edge.end());
  }
  for (const std::size_t k : {3, 1}) {
    const std::vector<Vec3> edge = raised(k);
    patch.points.insert(patch.points.end(), edge.begin() + 1, edge.end() - 1);
  }
  return patch;
}

}  // namespace patchmill
