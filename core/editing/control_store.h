// The control vectors of a network while it is edited. There is one control for each edge of a face.
#pragma once

#include <array>
#include <map>
#include <vector>

#include <absl/status/status.h>

#include "core/joining/curve_network.h"

namespace patchmill {

class ControlStore {
 public:
  // INVALID_ARGUMENT if two controls belong to the same edge and face.
  absl::Status Read(const std::vector<CrossControl>& controls);

  // The controls that were read, in their order, then the new ones.
  std::vector<CrossControl> List() const;

  // Replaces the vectors that `control` gives. Its other vector stays.
  void Put(const CrossControl& control);
  // As Put. Also drops the same vectors of the face across the edge.
  void Set(const CrossControl& control);
  // Drops the second derivatives of both faces at the edge.
  void DropSecond(const CrossControl& at);
  // Drops both vectors of the face across the edge.
  void DropAcross(const CrossControl& at);

 private:
  using Key = std::array<int, 3>;  // ends of the edge in ascending order, face
  static Key KeyOf(const CrossControl& c);
  template <class Visit>
  void ForEdge(const CrossControl& at, const Visit& visit);  // then drops empty controls

  std::vector<Key> order_;
  std::map<Key, CrossControl> controls_;
};

}  // namespace patchmill
