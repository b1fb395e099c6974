#include "cam/picture/facets.h"

#include <algorithm>
#include <cmath>

namespace patchmill {
namespace {

constexpr std::size_t kMaxFacets = 14000;  // in a view by region, before any are divided
constexpr std::size_t kMaxShaded = 10000;  // in a view by slope or curvature
constexpr double kFine = 4.0;              // px; facets at borders are divided to about this size
constexpr int kFinest = 4;                 // parts along each side of a facet, at most
constexpr const char* kWithoutRegion = "#d8d8d8";

int PerSide(const Surface& surface, std::size_t facets, int most) {
  const double per_piece =
      static_cast<double>(facets) / static_cast<double>(std::max<std::size_t>(1, surface.pieces.size()));
  return std::clamp(static_cast<int>(std::sqrt(per_piece)), 1, most);
}

class FacetMaker {
 public:
  FacetMaker(const PreviewInput& input, const View& view, Paint paint, int piece)
      : input_(input), view_(view), paint_(paint), id_(piece), piece_(input.surface->piece(id_)) {}

  // The facet over the square of parameters from (u,v), `side` wide.
  Facet Make(double u, double v, double side) const {
    Facet f;
    f.corners = {Position(piece_, u, v), Position(piece_, u + side, v), Position(piece_, u + side, v + side),
                 Position(piece_, u, v + side)};
    const Vec3 mid = 0.25 * (f.corners[0] + f.corners[1] + f.corners[2] + f.corners[3]);
    f.nearness = view_.Nearness(mid);
    const SurfaceJet jet = Evaluate(piece_, u + 0.5 * side, v + 0.5 * side);
    f.region = paint_ == Paint::kRegions ? RegionAt(u + 0.5 * side, v + 0.5 * side, mid) : -1;
    const bool known = f.region >= 0 && static_cast<std::size_t>(f.region) < input_.regions.size();
    f.color =
        paint_ != Paint::kRegions
            ? PaintedColor(paint_, jet, input_.scales)
            : Lit(known ? input_.regions[static_cast<std::size_t>(f.region)].color : kWithoutRegion, jet);
    return f;
  }
  bool Uniform(double u, double v, double side, const Facet& f) const {
    if (paint_ != Paint::kRegions) return true;
    constexpr double kIn = 0.02;  // of the side: distance from the corners, which neighbours share
    for (int k = 0; k < 4; ++k) {
      const double x = k == 1 || k == 2 ? 1.0 - kIn : kIn, y = k >= 2 ? 1.0 - kIn : kIn;
      if (RegionAt(u + x * side, v + y * side, f.corners[static_cast<std::size_t>(k)]) != f.region)
        return false;
    }
    return true;
  }

 private:
  int RegionAt(double u, double v, const Vec3& p) const {
    return input_.region_of ? input_.region_of({id_, u, v, p}) : -1;
  }

  const PreviewInput& input_;
  const View& view_;
  Paint paint_;
  PieceId id_;
  const Piece& piece_;
};

}  // namespace

int FacetsPerSide(const Surface& surface) { return PerSide(surface, kMaxFacets, 24); }

std::vector<Facet> MakeFacets(const PreviewInput& input, const View& view, Paint paint) {
  const Surface& surface = *input.surface;
  const int n = paint == Paint::kRegions ? FacetsPerSide(surface) : PerSide(surface, kMaxShaded, 80);
  const double side = 1.0 / n;
  std::vector<Facet> facets;
  for (std::size_t k = 0; k < surface.pieces.size(); ++k) {
    const FacetMaker maker(input, view, paint, static_cast<int>(k));
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        const double u = i * side, v = j * side;
        const Facet f = maker.Make(u, v, side);
        if (maker.Uniform(u, v, side, f)) {
          facets.push_back(f);
          continue;
        }
        const double size = std::max((view(f.corners[2]) - view(f.corners[0])).norm(),
                                     (view(f.corners[3]) - view(f.corners[1])).norm());
        const int parts = std::clamp(static_cast<int>(std::ceil(size / kFine)), 1, kFinest);
        for (int a = 0; a < parts; ++a) {
          for (int b = 0; b < parts; ++b)
            facets.push_back(maker.Make(u + a * side / parts, v + b * side / parts, side / parts));
        }
      }
    }
  }
  std::stable_sort(facets.begin(), facets.end(),
                   [](const Facet& a, const Facet& b) { return a.nearness < b.nearness; });
  return facets;
}

}  // namespace patchmill
