// The vertices of a ZeroMesh while it is made. Cells share them on the quadtree's grid; each sign is computed
// once.
#pragma once

#include <span>
#include <vector>

#include <absl/container/flat_hash_map.h>

#include "core/base/progress_throttle.h"
#include "core/lines/zero_mesh.h"

namespace patchmill {

inline constexpr int kZeroMaxLevel = 7;               // cells are at least 1/128 of a piece
inline constexpr int kZeroGrid = 1 << kZeroMaxLevel;  // all vertices lie on this grid before any cut

class ZeroVertices {
 public:
  // `run` is polled if not null. It gets the progress stage "cells" after too long a silence. After a
  // cancellation all values are zero.
  ZeroVertices(const Piece& piece, std::span<const ZeroField> fields, const RunContext* run = nullptr)
      : piece_(piece), fields_(fields), run_(run) {}

  // The vertex (gi,gj) / kZeroGrid. It is made on first use.
  int OnGrid(int gi, int gj);
  // Adds a vertex. Signs of smooth fields are computed at once, those of others on first use.
  int Add(const Vec2& q);
  // Puts the vertex on the curve of field k: its sign is 0 from now on.
  void PutOn(int id, std::size_t k);
  void SetSign(int id, std::size_t k, std::int8_t sign);
  int Sign(int id, std::size_t k);
  // Computes Sign(id, k) of all these vertices together. Repeated ids do no harm.
  void Ask(const std::vector<int>& ids, std::size_t k);
  // Values of field k at places between vertices, computed together.
  std::vector<double> Values(const std::vector<Vec2>& places, std::size_t k) const;
  // The sign -1, 0 or +1 of a value of field k.
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
  absl::flat_hash_map<int, int> grid_;  // looked up, never iterated
};

}  // namespace patchmill
