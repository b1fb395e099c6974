#include "core/lines/zero_vertices.h"

#include <algorithm>

#include "core/lines/zero_root.h"

namespace patchmill {

int ZeroVertices::OnGrid(int gi, int gj) {
  const auto [it, fresh] = grid_.try_emplace(gi * (kZeroGrid + 1) + gj, static_cast<int>(all_.size()));
  if (fresh) Add({static_cast<double>(gi) / kZeroGrid, static_cast<double>(gj) / kZeroGrid});
  return it->second;
}

int ZeroVertices::Add(const Vec2& q) {
  const SurfaceJet jet = Evaluate(piece_, q.x(), q.y());
  ZeroVertex vertex;
  vertex.u = q.x();
  vertex.v = q.y();
  vertex.p = jet.p;
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    if (!fields_[k].smooth) continue;
    vertex.sign[k] = SignOf(k, fields_[k].value(jet));
    vertex.known |= static_cast<ZeroFieldBits>(1u << k);
  }
  all_.push_back(vertex);
  return static_cast<int>(all_.size()) - 1;
}

void ZeroVertices::PutOn(int id, std::size_t k) {
  ZeroVertex& vertex = (*this)[id];
  vertex.on |= static_cast<ZeroFieldBits>(1u << k);
  vertex.known |= static_cast<ZeroFieldBits>(1u << k);
  vertex.sign[k] = 0;
}

void ZeroVertices::SetSign(int id, std::size_t k, std::int8_t sign) {
  (*this)[id].known |= static_cast<ZeroFieldBits>(1u << k);
  (*this)[id].sign[k] = sign;
}

int ZeroVertices::Sign(int id, std::size_t k) {
  if ((((*this)[id].known >> k) & 1u) == 0) {
    const int where = fields_[k].where;
    const bool asked = where < 0 || Sign(id, static_cast<std::size_t>(where)) != -fields_[k].where_sign;
    ZeroVertex& vertex = (*this)[id];
    vertex.known |= static_cast<ZeroFieldBits>(1u << k);
    vertex.sign[k] = asked ? SignOf(k, Value(fields_[k], piece_, {vertex.u, vertex.v})) : std::int8_t{0};
  }
  return (*this)[id].sign[k];
}

void ZeroVertices::Ask(const std::vector<int>& ids, std::size_t k) {
  if (!fields_[k].values) {
    for (const int id : ids) Sign(id, k);
    return;
  }
  const int where = fields_[k].where;
  if (where >= 0) Ask(ids, static_cast<std::size_t>(where));
  std::vector<int> asked;
  std::vector<Vec2> places;
  for (const int id : ids) {
    ZeroVertex& vertex = (*this)[id];
    if (((vertex.known >> k) & 1u) != 0) continue;
    vertex.known |= static_cast<ZeroFieldBits>(1u << k);
    if (where >= 0 && Sign(id, static_cast<std::size_t>(where)) == -fields_[k].where_sign)
      continue;  // its sign stays 0
    asked.push_back(id);
    places.emplace_back(vertex.u, vertex.v);
  }
  const std::vector<double> values = Values(places, k);
  for (std::size_t i = 0; i < asked.size(); ++i) (*this)[asked[i]].sign[k] = SignOf(k, values[i]);
}

std::vector<double> ZeroVertices::Values(const std::vector<Vec2>& places, std::size_t k) const {
  constexpr std::size_t kBetweenPolls = 1024;
  std::vector<SurfaceJet> jets;
  std::vector<double> values(places.size());
  for (std::size_t from = 0; from < places.size(); from += kBetweenPolls) {
    if (run_ != nullptr && run_->Cancelled()) break;
    if (run_ != nullptr) throttle_.ReportIfDue(*run_, "cells", from, places.size());
    const std::size_t count = std::min(kBetweenPolls, places.size() - from);
    jets.clear();
    for (std::size_t i = from; i < from + count; ++i)
      jets.push_back(Evaluate(piece_, places[i].x(), places[i].y()));
    if (fields_[k].values) {
      fields_[k].values(jets, std::span(values).subspan(from, count));
    } else {
      for (std::size_t i = 0; i < count; ++i) values[from + i] = fields_[k].value(jets[i]);
    }
  }
  return values;
}

std::int8_t ZeroVertices::SignOf(std::size_t k, double value) const {
  return static_cast<std::int8_t>(value > fields_[k].noise ? 1 : value < -fields_[k].noise ? -1 : 0);
}

}  // namespace patchmill
