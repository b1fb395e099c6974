#include "core/network/half_edges.h"

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <span>

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include "core/base/index.h"
#include "core/base/union_find.h"

namespace patchmill {
namespace {

struct MeshTraits : OpenMesh::DefaultTraits {
  VertexAttributes(0);
  FaceAttributes(0);
  EdgeAttributes(0);
  HalfedgeAttributes(OpenMesh::Attributes::PrevHalfedge);
};
using Mesh = OpenMesh::PolyMesh_ArrayKernelT<MeshTraits>;

// Edges of a patch in counter-clockwise order: which one, and whether its parameter runs that way.
struct Side {
  int edge;
  bool forward;
};
std::span<const Side> Boundary(int edge_count) {
  static constexpr std::array<Side, 4> kQuad = {{{0, true}, {1, true}, {2, false}, {3, false}}};
  static constexpr std::array<Side, 3> kTriangle = {{{0, true}, {1, true}, {2, false}}};
  if (edge_count == 3) return kTriangle;
  return kQuad;
}
class Builder {
 public:
  Builder(const EdgeCurves& curves, const std::vector<EdgeEnds>& ends, const std::vector<EdgeLink>& links,
          const std::vector<std::optional<PatchId>>& duplicate_of, const RunContext& run)
      : curves_(curves), ends_(ends), links_(links), duplicate_of_(duplicate_of), run_(run) {
    partner_.assign(links.size(), -1);
    for (int e = 0; e < curves.count(); ++e) {
      const auto& neighbor = links[At(e)].neighbor;
      if (!neighbor) continue;
      const int f = Index(*neighbor);
      const auto& back = links[At(f)].neighbor;
      if (back && *back == links[At(e)].self && e != f) partner_[At(e)] = f;
    }
    joined_ = partner_;
  }

  Topology Run() {
    Orient();
    SplitVertices();
    BuildMesh();
    return std::move(topology_);
  }

 private:
  int Index(PatchEdge e) const { return curves_.first_edge()[e.patch.index()] + e.edge; }
  int Edges(int patch) const {
    const bool last = At(patch) + 1 == curves_.first_edge().size();
    return (last ? curves_.count() : curves_.first_edge()[At(patch) + 1]) - curves_.first_edge()[At(patch)];
  }
  int Patches() const { return static_cast<int>(curves_.first_edge().size()); }
  bool Left(int patch) const { return duplicate_of_[At(patch)].has_value(); }
  // Both patches run the shared edge in the same direction, so one of them has to be turned.
  bool Opposed(int e) const {
    const int f = partner_[At(e)];
    const bool e_forward = curves_.edge(e).edge <= 1, f_forward = curves_.edge(f).edge <= 1;
    return (e_forward == f_forward) != links_[At(e)].reversed;
  }

  void Orient();
  void SplitVertices();
  void BuildMesh();
  std::vector<Mesh::VertexHandle> Outline(int patch);
  void AddPatch(int patch);

  // Corner slots: the two ends of each edge.
  int StartSlot(int e) const { return 2 * e; }
  int EndSlot(int e) const { return 2 * e + 1; }

  const EdgeCurves& curves_;
  const std::vector<EdgeEnds>& ends_;
  const std::vector<EdgeLink>& links_;
  const std::vector<std::optional<PatchId>>& duplicate_of_;
  const RunContext& run_;
  std::vector<int> joined_;   // mutual neighbour of each edge, -1 if it has none
  std::vector<int> partner_;  // as joined_, but cut where no orientation fits
  std::vector<bool> turned_;  // of each patch
  std::vector<int> fan_;      // of each corner slot
  std::vector<Mesh::VertexHandle> fan_vertex_, middle_;
  Mesh mesh_;
  Topology topology_;
};

void Builder::Orient() {
  turned_.assign(At(Patches()), false);
  std::vector<bool> seen(At(Patches()));
  std::vector<int> stack;
  for (int first = 0; first < Patches(); ++first) {
    if (seen[At(first)] || Left(first)) continue;
    Component component;
    component.first = PatchId(first);
    std::vector<int> members;
    seen[At(first)] = true;
    stack.push_back(first);
    while (!stack.empty()) {
      const int patch = stack.back();
      stack.pop_back();
      members.push_back(patch);
      for (int i = 0; i < Edges(patch); ++i) {
        const int e = curves_.first_edge()[At(patch)] + i;
        const int f = partner_[At(e)];
        if (f < 0) continue;
        const int other = curves_.edge(f).patch.value;
        const bool wanted = turned_[At(patch)] != Opposed(e);
        if (!seen[At(other)]) {
          seen[At(other)] = true;
          turned_[At(other)] = wanted;
          stack.push_back(other);
        } else if (turned_[At(other)] != wanted) {
          component.one_sided = true;
          partner_[At(e)] = partner_[At(f)] = -1;
        }
      }
    }
    std::sort(members.begin(), members.end());
    component.patches = static_cast<int>(members.size());
    const auto turned = std::count_if(members.begin(), members.end(), [&](int p) { return turned_[At(p)]; });
    const bool most = 2 * turned > component.patches;
    component.turned = most ? component.patches - static_cast<int>(turned) : static_cast<int>(turned);
    for (const int p : members) {
      if (turned_[At(p)] != most && !component.odd) component.odd = PatchId(p);
    }
    topology_.components.push_back(component);
  }
}

// Corners of patches around a vertex fall into fans: those that are connected by edges.
void Builder::SplitVertices() {
  UnionFind sets(2 * links_.size());
  const auto join = [&](int a, int b) { sets.Join(At(a), At(b)); };
  for (int patch = 0; patch < Patches(); ++patch) {
    const std::span<const Side> sides = Boundary(Edges(patch));
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const Side a = sides[i], b = sides[(i + 1) % sides.size()];
      const int e = curves_.first_edge()[At(patch)] + a.edge, f = curves_.first_edge()[At(patch)] + b.edge;
      join(a.forward ? EndSlot(e) : StartSlot(e), b.forward ? StartSlot(f) : EndSlot(f));
      if (links_[At(e)].collapsed) join(StartSlot(e), EndSlot(e));
      const int g = joined_[At(e)];
      if (g < 0) continue;
      join(StartSlot(e), links_[At(e)].reversed ? EndSlot(g) : StartSlot(g));
      join(EndSlot(e), links_[At(e)].reversed ? StartSlot(g) : EndSlot(g));
    }
  }
  fan_.resize(2 * links_.size());
  std::map<int, std::vector<int>> fans_at;  // vertex -> its fans
  for (int slot = 0; slot < static_cast<int>(fan_.size()); ++slot) {
    const int e = slot / 2;
    fan_[At(slot)] = static_cast<int>(sets.Find(At(slot)));
    if (Left(curves_.edge(e).patch.value)) continue;
    std::vector<int>& fans = fans_at[slot % 2 == 0 ? ends_[At(e)].start : ends_[At(e)].end];
    if (std::find(fans.begin(), fans.end(), fan_[At(slot)]) == fans.end()) fans.push_back(fan_[At(slot)]);
  }
  topology_.vertex_count = static_cast<int>(fans_at.size());
  for (const auto& [vertex, fans] : fans_at) {
    if (fans.size() > 1) topology_.split_vertices.push_back(vertex);
  }
}

// Corners and edge middles in turn, counter-clockwise, without collapsed edges. The middles keep edges
// between the same corners apart.
std::vector<Mesh::VertexHandle> Builder::Outline(int patch) {
  std::vector<Mesh::VertexHandle> outline;
  for (const Side side : Boundary(Edges(patch))) {
    const int e = curves_.first_edge()[At(patch)] + side.edge;
    if (links_[At(e)].collapsed) continue;
    Mesh::VertexHandle& corner = fan_vertex_[At(fan_[At(side.forward ? StartSlot(e) : EndSlot(e))])];
    if (!corner.is_valid()) corner = mesh_.add_vertex({});
    outline.push_back(corner);
    const int shared = partner_[At(e)] < 0 ? e : std::min(e, partner_[At(e)]);
    // An edge that ends where it starts needs a second vertex, or its two halves would be one edge.
    const bool loop = fan_[At(StartSlot(e))] == fan_[At(EndSlot(e))];
    const bool along = side.forward != (shared != e && links_[At(e)].reversed);
    for (const bool first : {true, false}) {
      if (!first && !loop) continue;
      Mesh::VertexHandle& middle = middle_[At(2 * shared + (loop && first != along ? 1 : 0))];
      if (!middle.is_valid()) middle = mesh_.add_vertex({});
      outline.push_back(middle);
    }
  }
  if (turned_[At(patch)]) std::reverse(outline.begin(), outline.end());
  return outline;
}

void Builder::AddPatch(int patch) {
  const std::vector<Mesh::VertexHandle> outline = Outline(patch);
  const std::size_t n = outline.size();
  std::vector<Mesh::VertexHandle> sorted = outline;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()) {
    if (n >= 3) mesh_.add_face(outline);
    return;
  }
  // A corner or an edge comes twice (seam of a tube, two corners in one pole). A ring of additional quads
  // keeps every face simple.
  std::vector<Mesh::VertexHandle> inner(n);
  for (Mesh::VertexHandle& v : inner) v = mesh_.add_vertex({});
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = (i + 1) % n;
    mesh_.add_face(std::vector<Mesh::VertexHandle>{outline[i], outline[j], inner[j], inner[i]});
  }
  if (n >= 3) mesh_.add_face(inner);
}

void Builder::BuildMesh() {
  static std::once_flag quiet;  // OpenMesh would write to stderr about faces it refuses
  std::call_once(quiet, [] { omerr().disable(); });
  fan_vertex_.resize(fan_.size());
  middle_.resize(2 * links_.size());
  for (int patch = 0; patch < Patches(); ++patch) {
    if (run_.Cancelled()) return;
    if (!Left(patch)) AddPatch(patch);
  }
  std::vector<bool> seen(mesh_.n_halfedges());
  for (const auto h : mesh_.halfedges()) {
    if (!mesh_.is_boundary(h) || seen[At(h.idx())]) continue;
    ++topology_.boundary_loop_count;
    for (auto g = Mesh::HalfedgeHandle(h); !seen[At(g.idx())]; g = mesh_.next_halfedge_handle(g)) {
      seen[At(g.idx())] = true;
    }
  }
  topology_.euler_characteristic = static_cast<int>(mesh_.n_vertices()) - static_cast<int>(mesh_.n_edges()) +
                                   static_cast<int>(mesh_.n_faces());
}

}  // namespace

Topology InspectTopology(const EdgeCurves& curves, const std::vector<EdgeEnds>& ends,
                         const std::vector<EdgeLink>& links,
                         const std::vector<std::optional<PatchId>>& duplicate_of, const RunContext& run) {
  return Builder(curves, ends, links, duplicate_of, run).Run();
}

}  // namespace patchmill
