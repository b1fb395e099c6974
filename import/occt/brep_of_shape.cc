#include "import/occt/brep_of_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <new>
#include <utility>

#include <BRepBndLib.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <absl/status/status.h>
#include <absl/strings/str_cat.h>
#include <absl/strings/str_format.h>

#include "core/base/status.h"
#include "import/occt/edge_table.h"
#include "import/occt/face_integrals.h"
#include "import/occt/face_loops.h"
#include "import/occt/failures.h"
#include "import/occt/free_edges.h"
#include "import/occt/surfaces.h"

namespace patchmill {
namespace {

struct ShapeBody {
  TopoDS_Shape shape;
  std::vector<TopoDS_Face> faces;
};

std::int64_t EntityOf(const ShapeLabels& labels, const TopoDS_Shape& shape) {
  const ShapeLabel* label = labels.Find(shape);
  return label == nullptr || label->entity == 0 ? std::numeric_limits<std::int64_t>::max() : label->entity;
}

std::vector<ShapeBody> BodiesOf(const TopoDS_Shape& shape, const ShapeLabels& labels) {
  std::vector<ShapeBody> bodies;
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) bodies.push_back({it.Current(), {}});
  for (TopExp_Explorer it(shape, TopAbs_SHELL, TopAbs_SOLID); it.More(); it.Next()) {
    bodies.push_back({it.Current(), {}});
  }
  TopoDS_Compound loose;
  BRep_Builder builder;
  builder.MakeCompound(loose);
  bool any_loose = false;
  for (TopExp_Explorer it(shape, TopAbs_FACE, TopAbs_SHELL); it.More(); it.Next()) {
    builder.Add(loose, it.Current());
    any_loose = true;
  }
  if (any_loose) bodies.push_back({loose, {}});
  for (ShapeBody& body : bodies) {
    for (TopExp_Explorer it(body.shape, TopAbs_FACE); it.More(); it.Next()) {
      body.faces.push_back(TopoDS::Face(it.Current()));
    }
    std::stable_sort(body.faces.begin(), body.faces.end(), [&](const TopoDS_Face& a, const TopoDS_Face& b) {
      return EntityOf(labels, a) < EntityOf(labels, b);
    });
  }
  return bodies;
}

class Reader {
 public:
  explicit Reader(const ShapeLabels& labels) : labels_(labels) {}

  void Add(const ShapeBody& shape) {
    const auto number = static_cast<int>(result_.model.bodies.size());
    const std::size_t first_face = result_.model.faces.size();
    const ShapeLabel whole = LabelOfBody(shape.shape);
    volume_ = 0.0;
    whole_ = true;
    face_count_.clear();
    for (const TopoDS_Face& face : shape.faces) ++face_count_[EntityOf(labels_, face)];
    for (const TopoDS_Face& face : shape.faces) AddFace(face, whole, number);
    if (result_.model.faces.size() == first_face) return;
    BrepBody body;
    body.name = whole.name;
    Measure(shape, first_face, body);
    result_.model.bodies.push_back(std::move(body));
  }

  BrepOfShapeResult Finish() {
    result_.model.edges = edges_.Edges();
    NumberInstances();
    return std::move(result_);
  }

 private:
  // What is said of the body itself, or of its only shell.
  ShapeLabel LabelOfBody(const TopoDS_Shape& body) const {
    if (const ShapeLabel* label = labels_.Find(body); label != nullptr) return *label;
    TopExp_Explorer shell(body, TopAbs_SHELL);
    if (shell.More()) {
      if (const ShapeLabel* label = labels_.Find(shell.Current()); label != nullptr) return *label;
    }
    return {};
  }

  void AddFace(const TopoDS_Face& shape, const ShapeLabel& body, int number) {
    const ShapeLabel* known = labels_.Find(shape);
    const ShapeLabel label = known == nullptr ? ShapeLabel{} : *known;
    if (label.hidden || body.hidden) {
      ++result_.hidden_faces;
      return;
    }
    BrepFace face;
    face.body = number;
    face.name = label.name;
    face.layer = label.layer.empty() ? body.layer : label.layer;
    face.rgb = label.rgb ? label.rgb : body.rgb;
    face.entity = label.entity;
    if (!seen_.Add(shape)) {
      whole_ = false;
      result_.findings.push_back(
          {"FACE_SHARED", "a face belongs to two bodies", LastFace(), label.entity, {}});
      return;
    }
    const absl::Status read = Guarded([&] { return Read(shape, face); });
    const int index = LastFace() + 1;
    if (!read.ok()) {
      whole_ = false;
      face.surface = BrepPlane{};
      face.loops.clear();
      if (const Box3 box = BoxOf(shape); !box.Empty()) face.box = box;
      std::string reason(read.message());
      std::string code = "FACE_UNREADABLE";
      for (const char* special : {"OFFSET_FOLDS", "NEGATIVE_WEIGHT"}) {
        if (reason.rfind(special, 0) == 0) {
          code = special;
          reason = reason.substr(code.size() + 1);
        }
      }
      result_.findings.push_back({std::move(code), std::move(reason), index, label.entity, BoxOf(shape)});
    } else if (overlaps_) {
      result_.findings.push_back({"FACE_OVERLAPS",
                                  "the border runs over more than a whole turn of the surface", index,
                                  label.entity, BoxOf(shape)});
    } else if (face_count_[label.entity] == 1 && !HasSeam(face) &&
               label.loop_count > static_cast<int>(face.loops.size())) {
      result_.findings.push_back(
          {"FACE_UNTRIMMED",
           absl::StrFormat("the file states %d loops, and %d were read", label.loop_count, face.loops.size()),
           index, label.entity, BoxOf(shape)});
    }
    result_.model.faces.push_back(std::move(face));
  }

  // Two loops of the file become one where the reader joins them by a seam.
  static bool HasSeam(const BrepFace& face) {
    return std::any_of(face.loops.begin(), face.loops.end(), [](const BrepLoop& loop) {
      return std::any_of(loop.begin(), loop.end(), [](const BrepEdgeUse& use) { return use.seam; });
    });
  }

  // Whether the border runs over more than a whole turn of the surface.
  static bool Overlaps(const Geom_Surface& bare, const NeededParameters& needed) {
    constexpr double kSlack = 1e-4;
    const auto beyond = [](const NeededParameters::Range& r, double period) {
      return r.high - r.low > (1.0 + kSlack) * period;
    };
    return (bare.IsUPeriodic() && beyond(needed.u, bare.UPeriod())) ||
           (bare.IsVPeriodic() && beyond(needed.v, bare.VPeriod()));
  }

  int LastFace() const { return static_cast<int>(result_.model.faces.size()) - 1; }

  absl::Status Read(const TopoDS_Face& shape, BrepFace& face) {
    const gp_Trsf placed = shape.Location().Transformation();
    if (std::abs(std::abs(placed.ScaleFactor()) - 1.0) > 1e-9) {
      return absl::InvalidArgumentError("the face is placed with a change of scale");
    }
    const Handle(Geom_Surface) given = BRep_Tool::Surface(shape);
    if (given.IsNull()) return absl::InvalidArgumentError("the face has no surface");
    const Handle(Geom_Surface) bare = BareSurface(given);
    PM_ASSIGN_OR_RETURN(const std::vector<SampledLoop> loops, SampleLoops(shape, bare, edges_));
    const NeededParameters needed = ParametersOf(loops);
    overlaps_ = Overlaps(*bare, needed);
    PM_ASSIGN_OR_RETURN(SurfacePart surface, SurfaceOver(bare, needed));
    // A mirror turns the surface's own normal against the mirrored one.
    face.reversed = (shape.Orientation() == TopAbs_REVERSED) != placed.IsNegative();
    if (const FaceIntegrals figures = IntegrateFace(bare, loops); std::isfinite(figures.area)) {
      face.area = figures.area;
      volume_ += face.reversed ? -figures.volume : figures.volume;
    }
    for (const SampledLoop& sampled : loops) {
      BrepLoop loop;
      for (const SampledUse& use : sampled) loop.push_back(UseOf(use, surface));
      face.loops.push_back(std::move(loop));
    }
    face.surface = std::move(surface.surface);
    face.surface_error = surface.error;
    return absl::OkStatus();
  }

  BrepEdgeUse UseOf(const SampledUse& sampled, const SurfacePart& surface) const {
    const TableEdge& edge = edges_.edge(sampled.edge);
    BrepEdgeUse use;
    use.edge = sampled.edge;
    use.forward = sampled.forward;
    use.seam = sampled.seam;
    for (std::size_t k = 0; k < sampled.at.size(); ++k) {
      const double at = edge.degenerate ? sampled.at[k] : edge.part.map(sampled.at[k]);
      if (!use.hint_at.empty() && at <= use.hint_at.back()) continue;
      use.hint_at.push_back(at);
      use.hint.push_back(surface.Map(sampled.place[k]));
    }
    if (!edge.degenerate) {
      use.hint_at.front() = edge.part.curve.knots.front();
      use.hint_at.back() = edge.part.curve.knots.back();
    }
    return use;
  }

  // Calls `f`, and makes a status of what it throws.
  template <class F>
  static absl::Status Guarded(const F& f) {
    try {
      return f();
    } catch (const Standard_Failure& failure) {
      return absl::InvalidArgumentError(TextOf(failure));
    } catch (const std::bad_alloc&) {
      return absl::ResourceExhaustedError("not enough memory");
    }
  }

  static Box3 BoxOf(const TopoDS_Face& face) {
    Box3 box;
    (void)Guarded([&] {
      Bnd_Box bounds;
      BRepBndLib::Add(face, bounds, false);
      if (bounds.IsVoid() || bounds.IsOpen()) return absl::OkStatus();
      Vec3 low, high;
      bounds.Get(low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
      box.Add(low);
      box.Add(high);
      return absl::OkStatus();
    });
    return box;
  }

  // Whether the body is closed, its volume, and that its faces look outward.
  void Measure(const ShapeBody& shape, std::size_t first_face, BrepBody& body) {
    body.solid = CountFreeEdges(shape.shape) == 0;
    if (body.solid && whole_) body.volume = volume_;
    std::vector<BrepFace>& faces = result_.model.faces;
    if (!body.volume || *body.volume >= 0.0) return;
    body.volume = -*body.volume;
    for (std::size_t f = first_face; f < faces.size(); ++f) faces[f].reversed = !faces[f].reversed;
    result_.findings.push_back({"INSIDE_OUT",
                                "the faces of a closed body looked inward",
                                static_cast<int>(first_face),
                                faces[first_face].entity,
                                {}});
  }

  // Bodies that have their name in common become "name.1", "name.2".
  void NumberInstances() {
    std::map<std::string, int> count, given;
    for (const BrepBody& body : result_.model.bodies) ++count[body.name];
    for (BrepBody& body : result_.model.bodies) {
      if (!body.name.empty() && count[body.name] > 1) {
        const int instance = ++given[body.name];
        body.name = absl::StrCat(body.name, ".", instance);
      }
    }
  }

  const ShapeLabels& labels_;
  EdgeTable edges_;
  TopTools_MapOfShape seen_;
  std::map<std::int64_t, int> face_count_;  // by number in the file, of the body that is read
  double volume_ = 0.0;                     // of the faces of the body that is read
  bool whole_ = true;                       // all of them were read
  bool overlaps_ = false;                   // the face that is read
  BrepOfShapeResult result_;
};

}  // namespace

absl::StatusOr<BrepOfShapeResult> BrepOfShape(const TopoDS_Shape& shape, const ShapeLabels& labels) {
  try {
    Reader reader(labels);
    for (const ShapeBody& body : BodiesOf(shape, labels)) reader.Add(body);
    BrepOfShapeResult result = reader.Finish();
    if (result.model.faces.empty()) return absl::FailedPreconditionError("the file holds no face");
    return result;
  } catch (const Standard_Failure& failure) {
    return absl::InvalidArgumentError(absl::StrCat("the shape cannot be followed: ", TextOf(failure)));
  }
}

}  // namespace patchmill
