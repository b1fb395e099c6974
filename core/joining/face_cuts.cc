#include "core/joining/face_cuts.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/index.h"
#include "core/joining/network_findings.h"

namespace patchmill {
namespace {

using Loop = std::vector<int>;

bool HasSide(const Loop& loop, int a, int b) {
  for (std::size_t k = 0; k < loop.size(); ++k) {
    if (std::minmax(loop[k], loop[(k + 1) % loop.size()]) == std::minmax(a, b)) return true;
  }
  return false;
}

// Cuts the piece that has both ends as corners; false if there is none.
bool Cut(std::vector<Loop>& pieces, const std::array<int, 2>& ends) {
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const auto a = std::ranges::find(pieces[k], ends[0]), b = std::ranges::find(pieces[k], ends[1]);
    if (a == pieces[k].end() || b == pieces[k].end() || a == b || HasSide(pieces[k], *a, *b)) continue;
    const auto [first, last] = std::minmax(a, b);
    Loop near(first, last + 1), far(last, pieces[k].end());
    far.insert(far.end(), pieces[k].begin(), first + 1);
    pieces[k] = std::move(near);
    pieces.push_back(std::move(far));
    return true;
  }
  return false;
}

bool ForSides(PatchScheme scheme, std::size_t sides) {
  switch (scheme) {
    case PatchScheme::kAuto:
      return true;
    case PatchScheme::kLoftTriangle:
    case PatchScheme::kGregoryTriangle:
      return sides == 3;
    case PatchScheme::kGregory:
    case PatchScheme::kBrown:
    case PatchScheme::kG2Gregory:
    case PatchScheme::kHosaka:
      return sides == 4;
  }
  return true;
}

// The pieces of one face; empty after a finding.
std::vector<Loop> PiecesOf(const NetworkFace& face, int index, const NetworkWriter& findings) {
  const auto error = [&](std::string_view text) {
    findings.Error("INVALID_CUT", findings.AtFace(index), text);
    return std::vector<Loop>();
  };
  if (face.vertices.size() > At(kMaxCutCorners)) {
    return error(fmt::format("has {} corners and cuts; at most {}", face.vertices.size(), kMaxCutCorners));
  }
  if (!face.pushes.empty()) return error("has cuts and is pushed; give its pieces as faces, and push these");
  if (!face.bulges.empty()) return error("has cuts and bulges; give its pieces as faces");
  std::vector<Loop> pieces = {face.vertices};
  for (const auto& ends : face.cuts) {
    if (Cut(pieces, ends)) continue;
    return error(fmt::format(
        "has a cut from vertex {} to {}; must join two of its corners that have no side in common "
        "and no other cut between them",
        ends[0], ends[1]));
  }
  return pieces;
}

}  // namespace

CurveNetwork WithCutFaces(CurveNetwork network, Diagnostics& list) {
  const int count = static_cast<int>(network.faces.size());
  if (std::ranges::all_of(network.faces, [](const NetworkFace& f) { return f.cuts.empty(); })) return network;
  const NetworkWriter findings(network, list);
  std::vector<std::vector<int>> pieces_of(At(count));  // faces of the result
  std::vector<NetworkFace> faces = network.faces;
  for (int f = 0; f < count; ++f) {
    const NetworkFace& face = network.faces[At(f)];
    if (face.cuts.empty()) continue;
    const std::vector<Loop> pieces = PiecesOf(face, f, findings);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      NetworkFace piece{face.id, pieces[k],
                        ForSides(face.scheme, pieces[k].size()) ? face.scheme : PatchScheme::kAuto};
      if (k > 0 && !face.id.empty()) piece.id += fmt::format("/{}", k + 1);
      for (const SideTwists& twists : face.twists) {
        const bool inner = !HasSide(face.vertices, twists.start, twists.end);  // no side: see CheckTwists
        if (HasSide(pieces[k], twists.start, twists.end) || (inner && k == 0)) piece.twists.push_back(twists);
      }
      pieces_of[At(f)].push_back(k == 0 ? f : static_cast<int>(faces.size()));
      if (k == 0) {
        faces[At(f)] = std::move(piece);
      } else {
        piece.of = f;
        faces.push_back(std::move(piece));
      }
    }
  }
  const auto cut = [&](int face) { return face >= 0 && face < count && !pieces_of[At(face)].empty(); };
  for (std::size_t v = 0; v < network.vertices.size(); ++v) {
    for (NetworkVertex::Normal& normal : network.vertices[v].normals) {
      std::vector<int> listed;
      for (const int f : normal.faces) {
        if (!cut(f)) {
          listed.push_back(f);
          continue;
        }
        for (const int piece : pieces_of[At(f)]) {
          if (std::ranges::count(faces[At(piece)].vertices, static_cast<int>(v)) > 0) listed.push_back(piece);
        }
      }
      normal.faces = std::move(listed);
    }
  }
  for (CrossControl& control : network.controls) {
    if (!cut(control.face)) continue;
    for (const int piece : pieces_of[At(control.face)]) {
      if (!HasSide(faces[At(piece)].vertices, control.start, control.end)) continue;
      control.face = piece;
      break;
    }
  }
  network.faces = std::move(faces);
  return network;
}

}  // namespace patchmill
