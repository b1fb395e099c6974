#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "core/network/control_points.h"
#include "core/network/patch_model.h"
#include "core/patch/split_pieces.h"

namespace patchmill {
namespace {

constexpr std::size_t kMaxFaults = 1000;

// Collects the faults of one model. Enter names the patch that they belong to.
class Faults {
 public:
  void Enter(const Patch& patch, std::size_t index, std::string_view kind) {
    patch_ = &patch;
    index_ = static_cast<int>(index);
    kind_ = kind;
  }
  // `field` is a field of the patch and may be empty. The message becomes "<path> <text>".
  void Add(std::string_view code, std::string_view field, std::string_view text) {
    Where where;
    where.patch_id = patch_->id;
    where.patch_index = index_;
    where.field = fmt::format("patches[{}].{}{}{}", index_, kind_, field.empty() ? "" : ".", field);
    AddAt(code, std::move(where), text);
  }
  // As Add, for a field that all kinds share.
  void AddToPatch(std::string_view code, std::string_view field, std::string_view text) {
    const std::string_view kind = std::exchange(kind_, field);
    Add(code, "", text);
    kind_ = kind;
  }
  void AddToModel(std::string_view code, std::string_view field, std::string_view text) {
    Where where;
    where.field = field;
    AddAt(code, std::move(where), text);
  }
  bool full() const { return found_.size() >= kMaxFaults; }
  Diagnostics Take() { return std::move(found_); }

 private:
  void AddAt(std::string_view code, Where where, std::string_view text) {
    if (full()) return;
    std::string message = fmt::format("{} {}", where.field, text);
    found_.push_back(MakeError(code, std::move(message), std::move(where)));
  }

  Diagnostics found_;
  const Patch* patch_ = nullptr;
  int index_ = 0;
  std::string_view kind_;
};

bool CheckDegree(int degree, std::string_view field, Faults& faults, int least = 1, int most = kMaxDegree) {
  if (degree >= least && degree <= most) return true;
  faults.Add("INVALID_DEGREE", field, fmt::format("= {}; must be in [{}, {}]", degree, least, most));
  return false;
}

void CheckPoints(std::span<const Vec3> points, Faults& faults) {
  Box3 box;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    const std::string field = "points";
    if (!p.allFinite()) {
      faults.Add("NOT_FINITE", field, fmt::format("has a number that is not finite in point {}", i));
      return;
    }
    if (!(p.cwiseAbs().maxCoeff() <= kMaxCoordinate)) {
      faults.Add("TOO_LARGE", field,
                 fmt::format("has {:g} in point {}; must be in [-{:g}, {:g}]", p.cwiseAbs().maxCoeff(), i,
                             kMaxCoordinate, kMaxCoordinate));
      return;
    }
    box.Add(p);
  }
  if (!points.empty() && !(box.Diagonal() > 0.0)) {
    faults.Add("ZERO_EXTENT", "points", "are all the same; the patch has no extent");
  }
}

void CheckWeights(const std::vector<double>& weights, std::size_t points, Faults& faults) {
  if (weights.empty()) return;
  if (weights.size() != points) {
    faults.Add("WEIGHT_COUNT", "weights",
               fmt::format("has {} numbers; must have none or one per point, {}", weights.size(), points));
    return;
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] >= kMinWeight && weights[i] <= kMaxWeight) continue;
    faults.Add(
        "INVALID_WEIGHT", "weights",
        fmt::format("has {:g} at point {}; must be in [{:g}, {:g}]", weights[i], i, kMinWeight, kMaxWeight));
    return;
  }
}

void CheckPointCount(std::size_t have, std::size_t want, Faults& faults) {
  if (have == want) return;
  faults.Add("POINT_COUNT", "points", fmt::format("has {} points; must have {}", have, want));
}

// Says what is wrong with a knot vector; empty if nothing is.
std::string KnotFault(std::span<const double> knots, int degree) {
  const auto p = static_cast<std::size_t>(degree);
  if (knots.size() < 2 * (p + 1)) {
    return fmt::format("has {} knots; degree {} needs at least {}", knots.size(), degree, 2 * (p + 1));
  }
  for (std::size_t i = 0; i < knots.size(); ++i) {
    if (!std::isfinite(knots[i]) || std::abs(knots[i]) > kMaxCoordinate) {
      return fmt::format("has {:g} at index {}; must be in [-{:g}, {:g}]", knots[i], i, kMaxCoordinate,
                         kMaxCoordinate);
    }
    if (i > 0 && knots[i] < knots[i - 1]) {
      return fmt::format("decreases from {:g} to {:g} at index {}", knots[i - 1], knots[i], i);
    }
  }
  const double begin = knots[p];
  const double end = knots[knots.size() - 1 - p];
  const double domain = end - begin;
  if (!(domain > 0.0)) return fmt::format("has an empty domain [{:g}, {:g}]", begin, end);
  if (domain < kMinKnotSpan * std::max(std::abs(begin), std::abs(end))) {
    return fmt::format("has a domain [{:g}, {:g}] too short for its offset", begin, end);
  }
  for (std::size_t i = 0; i < knots.size();) {
    std::size_t j = i;
    while (j < knots.size() && knots[j] == knots[i]) ++j;
    const bool inner = knots[i] > begin && knots[i] < end;
    const std::size_t most = inner ? p : p + 1;
    if (j - i > most) {
      return fmt::format("repeats {:g} {} times; at most {} for {} knot of degree {}", knots[i], j - i, most,
                         inner ? "an inner" : "an outer", degree);
    }
    if (j < knots.size() && knots[j] - knots[i] < kMinKnotSpan * domain) {
      return fmt::format("has knots {:g} apart at index {}; distinct knots must be {:g} of the domain apart",
                         knots[j] - knots[i], j, kMinKnotSpan);
    }
    i = j;
  }
  return "";
}

bool CheckKnots(std::span<const double> knots, int degree, std::string_view field, Faults& faults) {
  const std::string fault = KnotFault(knots, degree);
  if (fault.empty()) return true;
  faults.Add("INVALID_KNOTS", field, fault);
  return false;
}

std::string_view KindName(const PatchShape& shape) {
  static constexpr std::string_view kNames[] = {"bezier",        "bspline",    "gregory",
                                                "triangle",      "brown",      "gregory_triangle",
                                                "loft_triangle", "g2_gregory", "hosaka"};
  return kNames[shape.index()];
}

void CheckShape(const BezierPatch& b, Faults& faults) {
  const bool u = CheckDegree(b.degree_u, "degree_u", faults);
  const bool v = CheckDegree(b.degree_v, "degree_v", faults);
  if (u && v) {
    CheckPointCount(b.points.size(), static_cast<std::size_t>((b.degree_u + 1) * (b.degree_v + 1)), faults);
  }
  CheckPoints(b.points, faults);
  CheckWeights(b.weights, b.points.size(), faults);
}

void CheckShape(const BsplinePatch& b, Faults& faults) {
  bool sound = CheckDegree(b.degree_u, "degree_u", faults);
  sound = CheckDegree(b.degree_v, "degree_v", faults) && sound;
  if (sound) {
    sound = CheckKnots(b.knots_u, b.degree_u, "knots_u", faults);
    sound = CheckKnots(b.knots_v, b.degree_v, "knots_v", faults) && sound;
  }
  if (sound) {
    const std::size_t nu = b.knots_u.size() - static_cast<std::size_t>(b.degree_u) - 1;
    const std::size_t nv = b.knots_v.size() - static_cast<std::size_t>(b.degree_v) - 1;
    CheckPointCount(b.points.size(), nu * nv, faults);
  }
  CheckPoints(b.points, faults);
  CheckWeights(b.weights, b.points.size(), faults);
}

void CheckBulges(const std::vector<Bulge>& bulges, Faults& faults) {
  if (bulges.size() > kMaxBulges) {
    faults.AddToPatch("INVALID_BULGE", "bulges",
                      fmt::format("are {}; at most {}", bulges.size(), kMaxBulges));
    return;
  }
  for (const Bulge& b : bulges) {
    const auto inside = [](double t) { return t >= kMinBulgePlace && t <= 1.0 - kMinBulgePlace; };
    if (!inside(b.u) || !inside(b.v)) {
      faults.AddToPatch("INVALID_BULGE", "bulges",
                        fmt::format("have one at ({:g}, {:g}); both must be in [{:g}, {:g}]", b.u, b.v,
                                    kMinBulgePlace, 1.0 - kMinBulgePlace));
      return;
    }
    if (!b.by.allFinite() || b.by.cwiseAbs().maxCoeff() > kMaxCoordinate) {
      faults.AddToPatch("INVALID_BULGE", "bulges",
                        fmt::format("have one by ({:g}, {:g}, {:g}); must be finite and at most {:g}",
                                    b.by.x(), b.by.y(), b.by.z(), kMaxCoordinate));
      return;
    }
  }
}

void CheckShape(const GregoryPatch& g, Faults& faults) {
  CheckPoints(g.points, faults);
  CheckBulges(g.bulges, faults);
}

void CheckShape(const BezierTriangle& t, Faults& faults) {
  if (CheckDegree(t.degree, "degree", faults)) {
    CheckPointCount(t.points.size(), static_cast<std::size_t>((t.degree + 1) * (t.degree + 2) / 2), faults);
  }
  CheckPoints(t.points, faults);
  CheckWeights(t.weights, t.points.size(), faults);
}

bool CheckBreaks(const std::vector<double>& breaks, std::string_view field, Faults& faults) {
  if (breaks.size() > static_cast<std::size_t>(kMaxBrownBreaks)) {
    faults.Add("INVALID_BREAKS", field,
               fmt::format("has {} entries; at most {}", breaks.size(), kMaxBrownBreaks));
    return false;
  }
  double last = 0.0;
  for (const double at : breaks) {
    if (!(at >= last + kMinKnotSpan && at <= 1.0 - kMinKnotSpan)) {
      faults.Add("INVALID_BREAKS", field,
                 fmt::format("has {:g} after {:g}; must increase within (0, 1)", at, last));
      return false;
    }
    last = at;
  }
  return true;
}

void CheckShape(const BrownPatch& b, Faults& faults) {
  const bool u = CheckDegree(b.degree_u, "degree_u", faults, 3, kMaxBrownDegree);
  const bool v = CheckDegree(b.degree_v, "degree_v", faults, 3, kMaxBrownDegree);
  const bool breaks =
      CheckBreaks(b.breaks_u, "breaks_u", faults) && CheckBreaks(b.breaks_v, "breaks_v", faults);
  if (u && v && breaks) {
    const std::size_t n = static_cast<std::size_t>(b.degree_u) * (b.breaks_u.size() + 1),
                      m = static_cast<std::size_t>(b.degree_v) * (b.breaks_v.size() + 1);
    CheckPointCount(b.points.size(), 4 * (n + m) - 4, faults);
  }
  CheckPoints(b.points, faults);
  CheckBulges(b.bulges, faults);
}

void CheckShape(const GregoryTriangle& g, Faults& faults) { CheckPoints(g.points, faults); }

void CheckShape(const LoftTriangle& t, Faults& faults) {
  if (CheckDegree(t.degree, "degree", faults, 3, t.squared ? 4 : 3)) {
    CheckPointCount(t.points.size(), static_cast<std::size_t>(6 * t.degree - 3), faults);
  }
  CheckPoints(t.points, faults);
}

void CheckShape(const G2GregoryPatch& g, Faults& faults) {
  if (CheckDegree(g.degree, "degree", faults, 5, 7)) {
    CheckPointCount(g.points.size(), static_cast<std::size_t>((g.degree + 1) * (g.degree + 1) + 16), faults);
  }
  CheckPoints(g.points, faults);
  CheckBulges(g.bulges, faults);
}

void CheckBreaks(const HosakaPatch& h, Faults& faults) {
  for (std::size_t k = 0; k < h.breaks.size(); ++k) {
    const auto& list = h.breaks[k];
    const auto fault = [&](std::string_view text) {
      faults.Add("INVALID_BREAKS", "breaks", fmt::format("of side {} {}", k, text));
    };
    // Values may stay equal; places must increase.
    if (!list.empty() && h.blend == HosakaPatch::Blend::kLinear) fault("need the smooth blend");
    if (list.size() > static_cast<std::size_t>(kMaxHosakaBreaks)) {
      fault(fmt::format("have {} entries; at most {}", list.size(), kMaxHosakaBreaks));
    }
    HosakaPatch::Break last;
    for (const HosakaPatch::Break& b : list) {
      if (!(b.at >= last.at + kMinKnotSpan && b.value >= last.value && b.at <= 1.0 - kMinKnotSpan &&
            b.value <= 1.0)) {
        fault(fmt::format("have ({:g}, {:g}) after ({:g}, {:g}); must increase within (0, 1)", b.at, b.value,
                          last.at, last.value));
        break;
      }
      last = b;
    }
  }
}

void CheckShape(const HosakaPatch& h, Faults& faults) {
  const bool inner = h.inner_u >= 0 || h.inner_v >= 0;
  bool sound = CheckDegree(h.degree, "degree", faults, 1, 11);
  if (inner) {
    sound = CheckDegree(h.inner_u, "inner_degree_u", faults, 0, 4) && sound;
    sound = CheckDegree(h.inner_v, "inner_degree_v", faults, 0, 4) && sound;
    sound = CheckDegree(h.inner_order, "inner_order", faults, 1, 2) && sound;
  }
  if (sound) {
    const int count = 4 * h.degree + (inner ? (h.inner_u + 1) * (h.inner_v + 1) : 0);
    CheckPointCount(h.points.size(), static_cast<std::size_t>(count), faults);
  }
  CheckBreaks(h, faults);
  CheckPoints(h.points, faults);
  CheckBulges(h.bulges, faults);
}

// The number of points that counts for a patch. Few breaks or knots can cut it into many pieces, so it counts
// with the points of these.
std::size_t PointLoad(const PatchShape& shape) {
  const std::size_t given = ControlPoints(shape).size();
  const std::size_t bulges = Bulges(shape).size();
  std::size_t pieces = (bulges + 1) * (bulges + 1), each = 64;
  if (const auto* b = std::get_if<BsplinePatch>(&shape)) {
    return std::max(given, CountSplinePiecePoints({b->degree_u, b->knots_u}, {b->degree_v, b->knots_v}));
  }
  if (const auto* brown = std::get_if<BrownPatch>(&shape)) {
    pieces = (brown->breaks_u.size() + bulges + 1) * (brown->breaks_v.size() + bulges + 1);
    each = 64;  // the least, of bidegree 7
  } else if (const auto* h = std::get_if<HosakaPatch>(&shape)) {
    const auto& b = h->breaks;
    pieces = (b[0].size() + b[2].size() + bulges + 1) * (b[1].size() + b[3].size() + bulges + 1);
    each = 49;
  }
  return std::max(given, pieces > 1 ? pieces * each : 0);
}

void CheckIds(const PatchModel& model, Faults& faults) {
  std::unordered_map<std::string_view, std::size_t> first;
  for (std::size_t i = 0; i < model.patches.size(); ++i) {
    const Patch& patch = model.patches[i];
    if (patch.id.empty()) continue;
    const auto [it, fresh] = first.emplace(patch.id, i);
    if (fresh) continue;
    faults.Enter(patch, i, "id");
    faults.Add(
        "DUPLICATE_ID", "",
        fmt::format("= \"{}\" is also the id of patches[{}]; must be unique or empty", patch.id, it->second));
  }
}

void CheckFaces(const PatchModel& model, Faults& faults) {
  std::unordered_map<std::string_view, std::size_t> first;
  for (std::size_t f = 0; f < model.faces.size() && !faults.full(); ++f) {
    const ModelFace& face = model.faces[f];
    const std::string at = fmt::format("faces[{}]", f);
    if (face.id.empty()) faults.AddToModel("INVALID_FACE", at + ".id", "is missing");
    if (!std::isfinite(face.radius) || face.radius < 0.0) {
      faults.AddToModel("INVALID_FACE", at + ".radius_mm",
                        fmt::format("= {:g}; must be finite and at least 0", face.radius));
    }
    const auto [it, fresh] = first.emplace(face.id, f);
    if (fresh || face.id.empty()) continue;
    faults.AddToModel(
        "DUPLICATE_ID", at + ".id",
        fmt::format("= \"{}\" is also the id of faces[{}]; must be unique", face.id, it->second));
  }
  for (std::size_t i = 0; i < model.patches.size(); ++i) {
    const std::optional<FaceId>& face = model.patches[i].face;
    if (!face || (face->value >= 0 && face->index() < model.faces.size())) continue;
    faults.Enter(model.patches[i], i, "face_index");
    faults.Add("INVALID_FACE", "",
               fmt::format("= {}; the model has {} faces", face->value, model.faces.size()));
  }
}

void CheckExtent(const PatchModel& model, Faults& faults) {
  const Box3 box = ControlBox(model);
  const double diagonal = box.Diagonal();
  const double largest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  const double least_extent = kMinExtent * std::max(1.0, largest);
  if (diagonal < least_extent) {
    faults.AddToModel(
        "ZERO_EXTENT", "patches",
        fmt::format("extend over {:g} only, up to {:g} away from the origin; must be at least {:g}", diagonal,
                    largest, least_extent));
    return;
  }
  if (!model.join_tolerance) return;
  const double least = kMinJoinTolerance * diagonal;
  const double most = kMaxJoinTolerance * diagonal;
  if (*model.join_tolerance >= least && *model.join_tolerance <= most) return;
  faults.AddToModel("INVALID_JOIN_TOLERANCE", "join_tolerance",
                    fmt::format("= {:g}; must be in [{:g}, {:g}] for a box diagonal of {:g}",
                                *model.join_tolerance, least, most, diagonal));
}

}  // namespace

Diagnostics ValidateModel(const PatchModel& model) {
  Faults faults;
  const std::size_t count = model.patches.size();
  if (count < 1 || count > static_cast<std::size_t>(kMaxPatches)) {
    faults.AddToModel("PATCH_COUNT", "patches",
                      fmt::format("has {} patches; must have 1 to {}", count, kMaxPatches));
    return faults.Take();
  }
  std::size_t points = 0;
  for (const Patch& patch : model.patches) points += PointLoad(patch.shape);
  if (points > static_cast<std::size_t>(kMaxControlPoints)) {
    faults.AddToModel("POINT_COUNT", "patches",
                      fmt::format("have {} control points together; at most {}", points, kMaxControlPoints));
    return faults.Take();
  }
  for (std::size_t i = 0; i < count && !faults.full(); ++i) {
    const Patch& patch = model.patches[i];
    faults.Enter(patch, i, KindName(patch.shape));
    std::visit([&](const auto& shape) { CheckShape(shape, faults); }, patch.shape);
  }
  CheckIds(model, faults);
  CheckFaces(model, faults);
  Diagnostics found = faults.Take();
  if (!found.empty()) return found;
  Faults extent;  // only sound numbers have an extent
  CheckExtent(model, extent);
  return extent.Take();
}

}  // namespace patchmill
