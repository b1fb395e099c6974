#include "core/crossing/choose_cuts.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/base/index.h"
#include "core/crossing/embed_faces.h"

namespace patchmill {
namespace {

constexpr double kInLine = 165.0;      // degrees: a wider corner has no normal of its own
constexpr double kPerTriangle = 0.35;  // rad2
constexpr double kForbidden = 1e6;

class Cutter {
 public:
  Cutter(const std::vector<CutCorner>& corners, const std::function<bool(int, int)>& allowed)
      : corners_(corners), n_(static_cast<int>(corners.size())), allowed_(n_ * n_, false) {
    for (int i = 0; i < n_; ++i) {
      for (int j = 0; j < n_; ++j) {
        allowed_[At(i * n_ + j)] = !Beside(i, j) && i != j && allowed(i, j) && Inside(i, j) && Inside(j, i);
      }
    }
  }

  std::vector<std::vector<int>> Pieces() {
    if (Best(0, n_ - 1) >= kForbidden) return {};
    std::vector<std::vector<int>> pieces;
    Collect(0, n_ - 1, pieces);
    std::ranges::sort(pieces);
    return pieces;
  }

 private:
  struct Choice {
    double cost = kInfinity;
    std::vector<int> piece;
  };
  bool Beside(int i, int j) const { return (i + 1) % n_ == j || (j + 1) % n_ == i; }
  bool Joined(int i, int j) const { return Beside(i, j) || allowed_[At(i * n_ + j)]; }

  // The direction from corner i along the line to j: a side, or a cut.
  Vec3 Direction(int i, int j) const {
    if ((i + 1) % n_ == j) return corners_[At(i)].next;
    if ((j + 1) % n_ == i) return corners_[At(i)].previous;
    return corners_[At(j)].position - corners_[At(i)].position;
  }
  // The cut leaves corner i into the face.
  bool Inside(int i, int j) const {
    const CutCorner& c = corners_[At(i)];
    const double opening = AngleAbout(c.normal, c.next, c.previous);
    const double cut = AngleAbout(c.normal, c.next, Direction(i, j));
    return cut > Radians(5) && cut < opening - Radians(5);
  }

  double Cost(const std::vector<int>& piece) const {
    const auto count = piece.size();
    double cost = count == 3 ? kPerTriangle : 0.0;
    const double ideal = count == 3 ? kPi / 3 : kPi / 2;
    for (std::size_t k = 0; k < count; ++k) {
      const int c = piece[k];
      const double angle = AngleAbout(corners_[At(c)].normal, Direction(c, piece[(k + 1) % count]),
                                      Direction(c, piece[(k + count - 1) % count]));
      if (angle > Radians(kInLine) || angle < Radians(2)) return kForbidden;
      cost += (angle - ideal) * (angle - ideal);
    }
    return cost;
  }

  // The best pieces of the corners i .. j, closed by the line from j to i.
  double Best(int i, int j) {
    if (j - i < 2) return 0.0;
    const auto [entry, is_new] = best_.try_emplace(std::pair(i, j));
    if (!is_new) return entry->second.cost;
    Choice best;
    for (int k = i + 1; k < j; ++k) {
      if (!Joined(i, k) || !Joined(k, j)) continue;
      Try({i, k, j}, best);
    }
    for (int k = i + 1; k < j; ++k) {
      if (!Joined(i, k)) continue;
      for (int l = k + 1; l < j; ++l) {
        if (Joined(k, l) && Joined(l, j)) Try({i, k, l, j}, best);
      }
    }
    best_[{i, j}] = best;
    return best.cost;
  }

  void Try(const std::vector<int>& piece, Choice& best) {
    double cost = Cost(piece);
    for (std::size_t k = 0; k + 1 < piece.size() && cost < best.cost; ++k)
      cost += Best(piece[k], piece[k + 1]);
    if (cost < best.cost) best = {cost, piece};
  }

  void Collect(int i, int j, std::vector<std::vector<int>>& pieces) {
    if (j - i < 2) return;
    const std::vector<int> piece = best_[{i, j}].piece;
    pieces.push_back(piece);
    for (std::size_t k = 0; k + 1 < piece.size(); ++k) Collect(piece[k], piece[k + 1], pieces);
  }

  const std::vector<CutCorner>& corners_;
  int n_;
  std::vector<bool> allowed_;
  std::map<std::pair<int, int>, Choice> best_;
};

}  // namespace

std::vector<std::vector<int>> ChooseCuts(const std::vector<CutCorner>& corners,
                                         const std::function<bool(int, int)>& allowed) {
  if (corners.size() < 3 || corners.size() > At(kMaxCornersToCut)) return {};
  return Cutter(corners, allowed).Pieces();
}

}  // namespace patchmill
