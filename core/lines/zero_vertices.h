// The vertices of a ZeroMesh while it is made: shared on the quadtree's grid, with signs asked for once.
#pragma once

#include <span>
#include <vector>

#include <absl/container/flat_hash_map.h>

#include "core/base/progress_throttle.h"
#include "core/lines/zero_mesh.h"

namespace patchmill {

inline constexpr int kZeroMaxLevel = 7;               // cells down to 1/128 of a piece
inline constexpr int kZeroGrid = 1 << kZeroMaxLevel;  // vertices sit on this grid before any is cut in

class ZeroVertices {
 public:
  // `run`: polled when not null, and told "cells" after a silence that is too long; values asked for after a
  // cancel are zeros.
  ZeroVertices(const Piece& piece, std::span<const ZeroField> fields, const RunContext* run = nullptr)
      : piece_(piece), fields_(fields), run_(run) {}

  // The vertex (gi,gj) / kZeroGrid, made when first asked for.
  int OnGrid(int gi, int gj);
  // Signs of smooth fields at once, of others when they are asked for.
  int Add(const Vec2& q);
  // On the curve of field k: sign 0 from now on.
  void PutOn(int id, std::size_t k);
  void SetSign(int id, std::size_t k, std::int8_t sign);
  int Sign(int id, std::size_t k);
  // Sign(id, k) of all these at once; repeated ids do no harm.
  void Ask(const std::vector<int>& ids, std::size_t k);
  // Values of field k at places between vertices, at once.
  std::vector<double> Values(const std::vector<Vec2>& places, std::size_t k) const;
  // -1, 0 or +1 of a value of field k.
  std::int8_t SignOf(std::size_t k, double value) const;

  ZeroVertex& operator[](int id) { return all_[static_cast<std::size_t>(id)]; }
  const ZeroVertex& operator[](int id) const { return all_[static_cast<std::size_t>(id)]; }
  std::vector<ZeroVertex> Take() { return std::move(all_); }

 private:
  const Piece& piece_;
  std::span<const ZeroField> fields_;
  const RunContext* run_;
  mutable ProgressThrottle throttle_;
  std::vector<ZeroVertex> all_;
  absl::flat_hash_map<int, int> grid_;  // looked up, never walked
};

}  // namespace patchmill
