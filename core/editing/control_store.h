// Control vectors of a network while it is edited: one for each edge of a face.
#pragma once

#include <array>
#include <map>
#include <vector>

#include <absl/status/status.h>

#include "core/joining/curve_network.h"

namespace patchmill {

class ControlStore {
 public:
  // INVALID_ARGUMENT for two of one edge and face.
  absl::Status Read(const std::vector<CrossControl>& controls);

  // Those that were read in their order, then the new ones.
  std::vector<CrossControl> List() const;

  // What `control` gives replaces what is there; the rest stays.
  void Put(const CrossControl& control);
  // The same, and drops what it gives of the face across.
  void Set(const CrossControl& control);
  // Drops the second derivatives of both faces at the edge.
  void DropSecond(const CrossControl& at);
  // Drops what the face across has.
  void DropAcross(const CrossControl& at);

 private:
  using Key = std::array<int, 3>;  // ends of the edge in ascending order, face
  static Key KeyOf(const CrossControl& c);
  template <class Visit>
  void ForEdge(const CrossControl& at, const Visit& visit);  // and drops what is empty then

  std::vector<Key> order_;
  std::map<Key, CrossControl> controls_;
};

}  // namespace patchmill
