#include "core/editing/control_store.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include <fmt/format.h>

namespace patchmill {

ControlStore::Key ControlStore::KeyOf(const CrossControl& c) {
  return {std::min(c.start, c.end), std::max(c.start, c.end), c.face};
}

absl::Status ControlStore::Read(const std::vector<CrossControl>& controls) {
  for (std::size_t k = 0; k < controls.size(); ++k) {
    order_.push_back(KeyOf(controls[k]));
    if (controls_.emplace(order_.back(), controls[k]).second) continue;
    return absl::InvalidArgumentError(
        fmt::format("network.controls[{}] is the second one for its edge and face", k));
  }
  return absl::OkStatus();
}

std::vector<CrossControl> ControlStore::List() const {
  std::vector<CrossControl> list;
  std::map<Key, CrossControl> rest = controls_;
  for (const Key& key : order_) {
    if (const auto it = rest.find(key); it != rest.end()) list.push_back(it->second), rest.erase(it);
  }
  for (const auto& [key, control] : rest) list.push_back(control);
  return list;
}

template <class Visit>
void ControlStore::ForEdge(const CrossControl& at, const Visit& visit) {
  const Key here = KeyOf(at);
  auto it = controls_.lower_bound({here[0], here[1], std::numeric_limits<int>::min()});
  while (it != controls_.end() && it->first[0] == here[0] && it->first[1] == here[1]) {
    visit(it->second);
    it = it->second.first || it->second.second ? std::next(it) : controls_.erase(it);
  }
}

void ControlStore::Put(const CrossControl& control) {
  CrossControl& to = controls_.try_emplace(KeyOf(control), control).first->second;
  if (control.first) to.first = control.first;
  if (control.second) to.second = control.second;
}

void ControlStore::Set(const CrossControl& control) {
  ForEdge(control, [&](CrossControl& other) {
    if (other.face == control.face) return;
    if (control.first) other.first.reset();
    if (control.second) other.second.reset();
  });
  Put(control);
}

void ControlStore::DropSecond(const CrossControl& at) {
  ForEdge(at, [](CrossControl& control) { control.second.reset(); });
}

void ControlStore::DropAcross(const CrossControl& at) {
  ForEdge(at, [&](CrossControl& other) {
    if (other.face != at.face) other.first.reset(), other.second.reset();
  });
}

}  // namespace patchmill
