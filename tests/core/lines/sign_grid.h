// Connected zero lines counted by the signs on a dense grid over every patch: marching squares, and a union
// of what meets. Uses nothing of core/lines.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <ostream>
#include <vector>

#include "core/network/patch_model.h"

namespace patchmill::testing {

using Sign = std::function<double(const SurfaceJet&)>;

// mm: shorter sets are left out. The tracer's cells end at 1/128 of a patch, half a millimetre on the teapot,
// whose knob has lines that run around a hole of 0.03 mm.
inline constexpr double kSmallest = 1.0;

struct Counts {
  int lines = 0;  // connected sets
  int loops = 0;  // those of them without a free end
  bool operator==(const Counts&) const = default;
};
inline void PrintTo(const Counts& c, std::ostream* out) {
  *out << c.lines << " lines, " << c.loops << " closed";
}

// Sets of members with a place each, which grow together.
class Sets {
 public:
  int Add(const Box3& box) {
    parent_.push_back(static_cast<int>(parent_.size()));
    box_.push_back(box);
    return parent_.back();
  }
  int Root(int i) {
    while (parent_[At(i)] != i) i = parent_[At(i)] = parent_[At(parent_[At(i)])];
    return i;
  }
  void Unite(int i, int j) {
    i = Root(i), j = Root(j);
    if (i == j) return;
    parent_[At(i)] = j;
    box_[At(j)].Add(box_[At(i)]);
  }
  // An end at a border or a node: one with others there.
  void AddEnd(int member, const Vec3& p) { ends_.push_back({p, member}); }

  // Ends within `weld` of each other are one; who has an end of its own is open.
  Counts Count(double weld) {
    std::sort(ends_.begin(), ends_.end(), [](const End& a, const End& b) { return a.p.x() < b.p.x(); });
    std::vector<bool> alone(ends_.size(), true);
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      for (std::size_t j = i + 1; j < ends_.size() && ends_[j].p.x() - ends_[i].p.x() <= weld; ++j) {
        if ((ends_[i].p - ends_[j].p).norm() > weld) continue;
        Unite(ends_[i].member, ends_[j].member);
        alone[i] = alone[j] = false;
      }
    }
    std::vector<bool> open(parent_.size(), false);
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      if (alone[i]) open[At(Root(ends_[i].member))] = true;
    }
    Counts counts;
    for (std::size_t k = 0; k < parent_.size(); ++k) {
      if (parent_[k] != static_cast<int>(k) || box_[k].Diagonal() < kSmallest) continue;
      ++counts.lines;
      counts.loops += !open[k];
    }
    return counts;
  }

 private:
  struct End {
    Vec3 p;
    int member;
  };
  static std::size_t At(int i) { return static_cast<std::size_t>(i); }
  std::vector<int> parent_;
  std::vector<Box3> box_;
  std::vector<End> ends_;
};

inline Box3 BoxOf(const Vec3& p) {
  Box3 box;
  box.Add(p);
  return box;
}

// Where lines of a kind cross each other: nowhere in general, at saddles of the height, or wherever its
// gradient vanishes.
enum class Nodes { kNone, kSaddles, kFlat };

struct SignKind {
  Sign sign;
  Nodes nodes = Nodes::kNone;
};

// Marching squares over cells x cells of each patch. What passes one cell is one, and so is what passes the
// cells around a node: finer grids tell those apart that do not meet.
class SignGrid {
 public:
  SignGrid(const PatchModel& model, const Vec3& axis, int cells, double weld)
      : model_(model), axis_(axis), cells_(cells), side_(static_cast<std::size_t>(cells) + 1), weld_(weld) {}

  std::vector<Counts> Count(const std::vector<SignKind>& kinds) {
    std::vector<Sets> sets(kinds.size());
    jets_.resize(side_ * side_);
    for (const Patch& patch : model_.patches) {
      for (std::size_t i = 0; i < side_; ++i) {
        for (std::size_t j = 0; j < side_; ++j)
          jets_[i * side_ + j] = Evaluate(patch.shape, Parameter(i), Parameter(j));
      }
      FindFlatCells();
      for (std::size_t k = 0; k < kinds.size(); ++k) March(patch.shape, kinds[k], sets[k]);
    }
    std::vector<Counts> counts;
    for (Sets& s : sets) counts.push_back(s.Count(weld_));
    return counts;
  }

 private:
  // Not quite to the border, where edges may be collapsed and derivatives vanish.
  double Parameter(std::size_t i) const {
    constexpr double kInside = 1e-9;
    return std::clamp(static_cast<double>(i) / cells_, kInside, 1.0 - kInside);
  }
  std::array<std::size_t, 4> Corners(std::size_t i, std::size_t j) const {
    return {i * side_ + j, i * side_ + j + 1, (i + 1) * side_ + j, (i + 1) * side_ + j + 1};
  }

  // Cells where both derivatives of the height change sign.
  void FindFlatCells() {
    flat_.clear();
    for (std::size_t i = 0; i + 1 < side_; ++i) {
      for (std::size_t j = 0; j + 1 < side_; ++j) {
        int up_u = 0, up_v = 0, saddles = 0;
        for (const std::size_t k : Corners(i, j)) {
          const SurfaceJet& s = jets_[k];
          up_u += axis_.dot(s.du) > 0.0;
          up_v += axis_.dot(s.dv) > 0.0;
          saddles += axis_.dot(s.duu) * axis_.dot(s.dvv) < std::pow(axis_.dot(s.duv), 2);
        }
        if (up_u % 4 != 0 && up_v % 4 != 0) flat_.push_back({i, j, saddles == 4});
      }
    }
  }

  void March(const PatchShape& shape, const SignKind& kind, Sets& sets) {
    const Sign& field = kind.sign;
    std::vector<bool> positive(jets_.size());
    for (std::size_t k = 0; k < jets_.size(); ++k) positive[k] = field(jets_[k]) > 0.0;
    // The crossing on the edge from (i,j) along u, along v, or -1.
    std::array<std::vector<int>, 2> at = {std::vector<int>(jets_.size(), -1),
                                          std::vector<int>(jets_.size(), -1)};
    for (std::size_t i = 0; i < side_; ++i) {
      for (std::size_t j = 0; j < side_; ++j) {
        for (const std::size_t along : {0u, 1u}) {
          const std::size_t ni = along == 0 ? i + 1 : i, nj = along == 0 ? j : j + 1;
          const std::size_t from = i * side_ + j, to = ni * side_ + nj;
          if (ni == side_ || nj == side_ || positive[from] == positive[to]) continue;
          at[along][from] = sets.Add(BoxOf(jets_[from].p));
          const std::size_t border = along == 0 ? j : i;
          if (border != 0 && border + 1 != side_) continue;
          const Vec2 a(Parameter(i), Parameter(j)), b(Parameter(ni), Parameter(nj));
          sets.AddEnd(at[along][from], Crossing(shape, field, a, b, positive[from]));
        }
      }
    }
    const auto unite = [&](std::size_t i, std::size_t j, int first) {
      for (const int id : {at[0][i * side_ + j], at[0][i * side_ + j + 1], at[1][i * side_ + j],
                           at[1][(i + 1) * side_ + j]}) {
        if (id >= 0 && first >= 0) sets.Unite(id, first);
        if (id >= 0) first = id;
      }
      return first;
    };
    for (std::size_t i = 0; i + 1 < side_; ++i) {
      for (std::size_t j = 0; j + 1 < side_; ++j) unite(i, j, -1);
    }
    for (const auto& [i, j, saddle] : flat_) {
      if (kind.nodes == Nodes::kNone || (kind.nodes == Nodes::kSaddles && !saddle)) continue;
      int first = -1;
      for (std::size_t k = i - std::min<std::size_t>(i, 1); k < std::min(i + 2, side_ - 1); ++k) {
        for (std::size_t l = j - std::min<std::size_t>(j, 1); l < std::min(j + 2, side_ - 1); ++l)
          first = unite(k, l, first);
      }
    }
  }

  static Vec3 Crossing(const PatchShape& shape, const Sign& field, Vec2 a, Vec2 b, bool positive_at_a) {
    for (int step = 0; step < 50; ++step) {
      const Vec2 m = 0.5 * (a + b);
      ((field(Evaluate(shape, m.x(), m.y())) > 0.0) == positive_at_a ? a : b) = m;
    }
    return Evaluate(shape, a.x(), a.y()).p;
  }

  const PatchModel& model_;
  const Vec3 axis_;
  const int cells_;
  const std::size_t side_;
  const double weld_;
  std::vector<SurfaceJet> jets_;
  struct FlatCell {
    std::size_t i, j;
    bool saddle;
  };
  std::vector<FlatCell> flat_;
};

}  // namespace patchmill::testing
