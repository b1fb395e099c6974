#include "core/exchange/spline_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include <Eigen/LU>
#include <fmt/format.h>

#include "core/base/index.h"
#include "core/base/status.h"
#include "core/math/bernstein.h"
#include "core/patch/piece.h"

namespace patchmill {
namespace {

constexpr int kFitDegree = 7;
constexpr int kFitDepth = 14;  // quarterings of one piece
constexpr int kFitSamples = 11;
constexpr double kSamePlace = 1e-12;  // share of the size: nearer points are one

using FitMatrix = Eigen::Matrix<double, kFitDegree + 1, kFitDegree + 1>;

double FitNode(int k) { return 0.5 * (1.0 - std::cos(std::numbers::pi * k / kFitDegree)); }

// From values at the nodes to Bezier points.
const FitMatrix& FromValues() {
  static const FitMatrix kMatrix = [] {
    FitMatrix values;
    for (int k = 0; k <= kFitDegree; ++k) {
      double basis[kMaxBasisDegree + 1];
      AllBernstein(kFitDegree, FitNode(k), basis);
      for (int j = 0; j <= kFitDegree; ++j) values(k, j) = basis[j];
    }
    return FitMatrix(values.inverse());
  }();
  return kMatrix;
}

std::vector<double> BezierKnots(int degree) {
  std::vector<double> knots(At(2 * (degree + 1)), 0.0);
  std::fill(knots.begin() + degree + 1, knots.end(), 1.0);
  return knots;
}

BsplinePatch FromNet(const BernsteinNet& net) {
  BsplinePatch patch{
      net.degree_u, net.degree_v, BezierKnots(net.degree_u), BezierKnots(net.degree_v), {}, {}};
  for (const Vec4& h : net.points) {
    patch.points.push_back(h.head<3>() / h.w());
    if (net.rational) patch.weights.push_back(h.w());
  }
  return patch;
}

bool Clamped(const std::vector<double>& knots, int degree) {
  return knots[0] == knots[At(degree)] && knots.back() == knots[knots.size() - 1 - At(degree)];
}

// Two opposite sides are one curve.
bool Closed(const BsplinePatch& patch) {
  const std::size_t nv = patch.knots_v.size() - At(patch.degree_v) - 1, nu = patch.points.size() / nv;
  Box3 box;
  for (const Vec3& p : patch.points) box.Add(p);
  const double near = kSamePlace * box.Diagonal();
  bool u = true, v = true;
  for (std::size_t j = 0; j < nv; ++j)
    u = u && (patch.points[j] - patch.points[(nu - 1) * nv + j]).norm() <= near;
  for (std::size_t i = 0; i < nu; ++i)
    v = v && (patch.points[i * nv] - patch.points[i * nv + nv - 1]).norm() <= near;
  return u || v;
}

class Exporter {
 public:
  Exporter(const PatchModel& model, const RunContext& run) : model_(model), run_(run) {}

  absl::StatusOr<SplineSurfaces> Export() {
    for (std::size_t k = 0; k < model_.patches.size(); ++k) {
      PM_RETURN_IF_ERROR(run_.Check());
      PM_RETURN_IF_ERROR(AddPatch(k));
      if (result_.surfaces.size() > kMaxSplineSurfaces) {
        return absl::ResourceExhaustedError(
            fmt::format("the model becomes more than {} surfaces; convert it in parts", kMaxSplineSurfaces));
      }
    }
    if (fitted_ > 0) {
      const bool within = worst_ <= 0.5 * kSplineFit;
      result_.findings.push_back(MakeDiagnostic(
          within ? Severity::kInfo : Severity::kWarning, "EXPORT_FITTED",
          fmt::format(
              "{} of {} patches are of kinds that no other system knows; {} surfaces of degree {} stand for "
              "them, within {:.3g} mm",
              fitted_, model_.patches.size(), fits_, kFitDegree, within ? kSplineFit : 2.0 * worst_)));
    }
    return std::move(result_);
  }

 private:
  std::string NameOf(std::size_t k) const {
    const Patch& patch = model_.patches[k];
    std::string name = patch.face ? model_.faces[patch.face->index()].id : patch.id;
    std::erase_if(name, [](unsigned char c) { return c < 0x20 || c > 0x7e || c == '\'' || c == '\\'; });
    return name.empty() ? fmt::format("patch {}", k) : name.substr(0, kMaxSplineName);
  }

  absl::Status AddPatch(std::size_t k) {
    const PatchShape& shape = model_.patches[k].shape;
    const std::string name = NameOf(k);
    if (const auto* bspline = std::get_if<BsplinePatch>(&shape)) {
      if (Clamped(bspline->knots_u, bspline->degree_u) && Clamped(bspline->knots_v, bspline->degree_v) &&
          !Closed(*bspline)) {
        result_.surfaces.push_back({name, *bspline});
        return absl::OkStatus();
      }
    }
    const std::size_t before = result_.surfaces.size();
    bool fitted = false;
    for (const Piece& piece : SplitIntoPieces(PatchId{static_cast<int>(k)}, shape)) {
      const bool exact = std::ranges::all_of(piece.net.points, [](const Vec4& h) { return h.w() > 0.0; }) &&
                         piece.gregory == nullptr && piece.shape == nullptr;
      if (exact) {
        AddNet(name, piece.net);
      } else {
        fitted = true;
        PM_RETURN_IF_ERROR(AddFit(name, piece, {}, 0));
      }
    }
    if (fitted) ++fitted_, fits_ += result_.surfaces.size() - before;
    return absl::OkStatus();
  }

  // A net whose opposite sides are one curve goes out in quarters.
  void AddNet(const std::string& name, const BernsteinNet& net) {
    BsplinePatch patch = FromNet(net);
    if (!Closed(patch)) {
      result_.surfaces.push_back({name, std::move(patch)});
      return;
    }
    for (const double u : {0.0, 0.5}) {
      for (const double v : {0.0, 0.5})
        result_.surfaces.push_back({name, FromNet(SubNet(net, u, u + 0.5, v, v + 0.5))});
    }
  }

  absl::Status AddFit(const std::string& name, const Piece& piece, const ParameterBox& box, int depth) {
    PM_RETURN_IF_ERROR(run_.Check());
    const auto place = [&](double a, double b) {
      return Position(piece, std::lerp(box.u0, box.u1, a), std::lerp(box.v0, box.v1, b));
    };
    std::array<FitMatrix, 3> values;
    for (int i = 0; i <= kFitDegree; ++i) {
      for (int j = 0; j <= kFitDegree; ++j) {
        const Vec3 p = place(FitNode(i), FitNode(j));
        for (int c = 0; c < 3; ++c) values[At(c)](i, j) = p[c];
      }
    }
    for (FitMatrix& m : values) m = FitMatrix(FromValues() * m * FromValues().transpose());
    BernsteinNet net{kFitDegree, kFitDegree, false, {}};
    for (int i = 0; i <= kFitDegree; ++i) {
      for (int j = 0; j <= kFitDegree; ++j) {
        // Corners are given exactly: neighbours meet there to the bit.
        const bool corner = (i == 0 || i == kFitDegree) && (j == 0 || j == kFitDegree);
        const Vec3 p = corner ? place(i == 0 ? 0 : 1, j == 0 ? 0 : 1)
                              : Vec3(values[0](i, j), values[1](i, j), values[2](i, j));
        net.points.push_back(Vec4(p.x(), p.y(), p.z(), 1.0));
      }
    }
    const BsplinePatch patch = FromNet(net);
    double most = 0.0;
    const BezierPatch bezier{kFitDegree, kFitDegree, patch.points, {}};
    for (int i = 0; i < kFitSamples; ++i) {
      for (int j = 0; j < kFitSamples; ++j) {
        const double a = (i + 0.5) / kFitSamples, b = (j + 0.5) / kFitSamples;
        most = std::max(most, (Position(PatchShape(bezier), a, b) - place(a, b)).norm());
      }
    }
    // Half of the bound: samples may miss the largest distance.
    if (most <= 0.5 * kSplineFit || depth == kFitDepth) {
      worst_ = std::max(worst_, most);
      result_.surfaces.push_back({name, patch});
      return absl::OkStatus();
    }
    if (result_.surfaces.size() > kMaxSplineSurfaces) return absl::OkStatus();
    const double u = std::midpoint(box.u0, box.u1), v = std::midpoint(box.v0, box.v1);
    for (const ParameterBox& part : {ParameterBox{box.u0, u, box.v0, v},
                                     {u, box.u1, box.v0, v},
                                     {box.u0, u, v, box.v1},
                                     {u, box.u1, v, box.v1}}) {
      PM_RETURN_IF_ERROR(AddFit(name, piece, part, depth + 1));
    }
    return absl::OkStatus();
  }

  const PatchModel& model_;
  const RunContext& run_;
  SplineSurfaces result_;
  std::size_t fitted_ = 0, fits_ = 0;
  double worst_ = 0.0;  // mm, largest distance of a fit from its patch
};

}  // namespace

absl::StatusOr<SplineSurfaces> SplineSurfacesOf(const PatchModel& model, const RunContext& run) {
  return Exporter(model, run).Export();
}

}  // namespace patchmill
