#include "core/patch/condition_pieces.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/vec.h"
#include "core/math/bernstein.h"

namespace patchmill::internal {
namespace {

constexpr int kMostCuts = 24;  // of one span, in each direction

// A slab of the grid: the pieces of one span in one direction.
struct Slab {
  std::vector<Piece> pieces;
  int cuts = 0;  // halvings that led to it
};

// The lines of a net along one direction.
struct NetLines {
  int degree, count;    // of a line, and of the lines
  int step, line_step;  // from a point to the next one on its line, and to that of the next line

  std::size_t at(int line, int k) const { return static_cast<std::size_t>(line * line_step + k * step); }
};

NetLines LinesOf(const BernsteinNet& net, bool along_u) {
  const int row = net.degree_v + 1;
  if (along_u) return {net.degree_u, row, row, 1};
  return {net.degree_v, net.degree_u + 1, 1, row};
}

// The mean slope of the logarithms of the weights along the lines of a slab, by least squares.
double MeanSlope(const Slab& slab, bool along_u) {
  double sum = 0.0, norm = 0.0;
  for (const Piece& piece : slab.pieces) {
    const NetLines lines = LinesOf(piece.net, along_u);
    for (int line = 0; line < lines.count; ++line) {
      for (int k = 0; k <= lines.degree; ++k) {
        const double x = k - 0.5 * lines.degree;
        sum += x * std::log2(piece.net.points[lines.at(line, k)].w());
        norm += x * x;
      }
    }
  }
  return norm > 0.0 ? sum / norm : 0.0;
}

// The largest range of the logarithms along a line of a slab.
double LargestRange(const Slab& slab, bool along_u) {
  double largest = 0.0;
  for (const Piece& piece : slab.pieces) {
    const NetLines lines = LinesOf(piece.net, along_u);
    for (int line = 0; line < lines.count; ++line) {
      double low = kInfinity, high = -kInfinity;
      for (int k = 0; k <= lines.degree; ++k) {
        const double w = std::log2(piece.net.points[lines.at(line, k)].w());
        low = std::min(low, w);
        high = std::max(high, w);
      }
      largest = std::max(largest, high - low);
    }
  }
  return largest;
}

// Multiplies the weights of point k of each line by 2^(-slope k), `slope` rounded.
void Balance(bool along_u, Slab& slab) {
  const int slope = static_cast<int>(std::lround(MeanSlope(slab, along_u)));
  if (slope == 0) return;
  for (Piece& piece : slab.pieces) {
    const NetLines lines = LinesOf(piece.net, along_u);
    for (int line = 0; line < lines.count; ++line) {
      for (int k = 0; k <= lines.degree; ++k)
        piece.net.points[lines.at(line, k)] *= std::ldexp(1.0, -slope * k);
    }
    (along_u ? piece.speed.x() : piece.speed.y()) *= std::ldexp(1.0, -slope);
  }
}

// The halves of a piece. The speed at which a half's parameter begins is that of the whole there.
std::pair<Piece, Piece> Halves(const Piece& piece, bool along_u) {
  std::pair<Piece, Piece> halves(piece, piece);
  auto& [low, high] = halves;
  low.net = along_u ? SubNet(piece.net, 0.0, 0.5, 0.0, 1.0) : SubNet(piece.net, 0.0, 1.0, 0.0, 0.5);
  high.net = along_u ? SubNet(piece.net, 0.5, 1.0, 0.0, 1.0) : SubNet(piece.net, 0.0, 1.0, 0.5, 1.0);
  const auto corner = [&](double u, double v) { return NativeParameters(piece, u, v); };
  if (along_u) {
    low.native[1] = high.native[0] = corner(0.5, 0.0);
    low.native[3] = high.native[2] = corner(0.5, 1.0);
  } else {
    low.native[2] = high.native[0] = corner(0.0, 0.5);
    low.native[3] = high.native[1] = corner(1.0, 0.5);
  }
  const int axis = along_u ? 0 : 1;
  const double end = piece.speed[axis], middle = 0.5 * (1.0 + end);
  low.speed[axis] = middle;
  high.speed[axis] = end / middle;
  return halves;
}

// The slabs that a slab is cut into, balanced, in order.
void Cut(Slab slab, bool along_u, std::vector<Slab>& out) {
  if (LargestRange(slab, along_u) >= kEvenWeights) Balance(along_u, slab);
  if (LargestRange(slab, along_u) < kEvenWeights || slab.cuts >= kMostCuts) {
    out.push_back(std::move(slab));
    return;
  }
  Slab low{{}, slab.cuts + 1}, high{{}, slab.cuts + 1};
  for (const Piece& piece : slab.pieces) {
    auto [first, second] = Halves(piece, along_u);
    low.pieces.push_back(std::move(first));
    high.pieces.push_back(std::move(second));
  }
  slab = {};
  Cut(std::move(low), along_u, out);
  Cut(std::move(high), along_u, out);
}

// Pieces of the first span along u: those with the same native u at their corner as the first.
std::size_t CountRows(const std::vector<Piece>& pieces) {
  std::size_t rows = 1;
  while (rows < pieces.size() && pieces[rows].native[0].x() == pieces[0].native[0].x()) ++rows;
  return rows;
}

bool IsEven(const std::vector<Piece>& pieces) {
  for (const Piece& piece : pieces) {
    const auto [low, high] = std::minmax_element(piece.net.points.begin(), piece.net.points.end(),
                                                 [](const Vec4& a, const Vec4& b) { return a.w() < b.w(); });
    if (high->w() >= low->w() * std::exp2(kEvenWeights)) return false;
  }
  return true;
}

}  // namespace

std::vector<Piece> ConditionPieces(std::vector<Piece> pieces) {
  if (pieces.empty() || IsEven(pieces)) return pieces;
  std::size_t rows = CountRows(pieces);
  std::vector<Slab> columns;
  for (std::size_t k = 0; k < pieces.size(); k += rows) {
    Slab column;
    for (std::size_t r = 0; r < rows; ++r) column.pieces.push_back(std::move(pieces[k + r]));
    Cut(std::move(column), true, columns);
  }
  std::vector<Slab> cut_rows;
  for (std::size_t r = 0; r < rows; ++r) {
    Slab row;
    for (Slab& column : columns) row.pieces.push_back(std::move(column.pieces[r]));
    Cut(std::move(row), false, cut_rows);
  }
  pieces.clear();
  for (std::size_t c = 0; c < columns.size(); ++c) {
    for (Slab& row : cut_rows) pieces.push_back(std::move(row.pieces[c]));
  }
  return pieces;
}

}  // namespace patchmill::internal
