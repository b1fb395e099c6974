#include "server/convert/drawing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "cam/toolpath/motion_time.h"
#include "server/convert/enums.h"
#include "server/convert/fields.h"
#include "server/limits.h"

namespace patchmill {
namespace {

void Add(const Vec3& p, google::protobuf::RepeatedField<float>& numbers) {
  for (int k = 0; k < 3; ++k) numbers.Add(static_cast<float>(p[k]));
}
void Add(const Vec3& p, google::protobuf::RepeatedField<double>& numbers) {
  for (int k = 0; k < 3; ++k) numbers.Add(p[k]);
}

v1::PassKind ToProto(PassKind kind) {
  switch (kind) {
    case PassKind::kZigzag:
      return v1::PASS_KIND_ZIGZAG;
    case PassKind::kContour:
      return v1::PASS_KIND_CONTOUR;
    case PassKind::kBorder:
      return v1::PASS_KIND_BORDER;
    case PassKind::kPencil:
      return v1::PASS_KIND_PENCIL;
    case PassKind::kRest:
      return v1::PASS_KIND_REST;
  }
  return v1::PASS_KIND_UNSPECIFIED;
}

// Collects moves, and emits them in blocks of limits::kPathChunkPoints.
class BlockEmitter {
 public:
  explicit BlockEmitter(const std::function<bool(v1::PathBlock)>& emit) : emit_(emit) {}

  // The block for the next move; null if `emit` has stopped.
  v1::PathBlock* Next() {
    if (block_.line_size() == static_cast<int>(limits::kPathChunkPoints) && !Flush()) return nullptr;
    return &block_;
  }
  bool Flush() { return block_.line_size() == 0 || emit_(std::exchange(block_, {})); }

 private:
  const std::function<bool(v1::PathBlock)>& emit_;
  v1::PathBlock block_;
};

// The arc by its centre and its turns. `tip_offset` leads from the tip to the frame of the ends.
void AddArc(const Arc& arc, const ArcEnds& ends, const Vec3& tip_offset, v1::PathBlock& block) {
  block.add_arc_plane(ToProto(arc.plane));
  const Vec3 center = FromPlane(arc.plane, Lift(arc.center, ToPlane(arc.plane, ends.from).z()));
  Add(center - tip_offset, *block.mutable_arc_center_mm());
  block.add_arc_turns((arc.clockwise ? -1.0 : 1.0) * Sweep(arc, ends) / (2.0 * kPi));
}

void AddPiece(const PieceTriangles& piece, PatchId patch, const Vec3& zero, v1::MeshBlock& block) {
  const auto first = block.slope_deg_size();
  for (const MeshVertex& vertex : piece.vertices) {
    Add(vertex.at.p - zero, *block.mutable_position_mm());
    Add(vertex.normal, *block.mutable_normal());
    block.add_slope_deg(static_cast<float>(Degrees(vertex.slope)));
    block.add_contour_curvature_per_mm(static_cast<float>(vertex.contour_curvature));
  }
  for (const MeshTriangle& triangle : piece.triangles) {
    for (const std::uint32_t corner : triangle.vertices) block.add_corners(first + static_cast<int>(corner));
    block.add_patch_index(patch.value);
    block.add_region_id(triangle.label);
  }
}

}  // namespace

double ReadChord(double asked, FieldErrors& errors) {
  Require(errors, "tessellation_chord_mm", asked,
          asked >= limits::kMinChordMm && asked <= limits::kMaxChordMm,
          fmt::format("in [{}, {}]", limits::kMinChordMm, limits::kMaxChordMm));
  return asked;
}

std::vector<std::string> PatchNames(const PatchModel& model) {
  std::vector<std::string> names;
  for (const Patch& patch : model.patches)
    names.push_back(patch.face ? model.faces[patch.face->index()].id : patch.id);
  return names;
}

bool EmitMesh(const SurfaceDrawing& drawing, const Surface& surface, const Vec3& zero,
              const std::function<bool(v1::MeshBlock)>& emit) {
  v1::MeshBlock block;
  for (std::string& name : PatchNames(surface.network.model)) block.add_patch_names(Utf8(name));
  std::size_t vertex = 0;  // among those of all pieces
  for (const PieceTriangles& piece : drawing.mesh) {
    const auto size = static_cast<std::size_t>(block.slope_deg_size());
    if (size > 0 && size + piece.vertices.size() > limits::kMeshBlockVertices &&
        !emit(std::exchange(block, {})))
      return false;
    block.set_chord_mm(drawing.chord);
    AddPiece(piece, surface.piece(piece.piece).patch, zero, block);
    if (drawing.motion) {
      for (std::size_t k = 0; k < piece.vertices.size(); ++k) {
        block.add_leftover_mm(static_cast<float>(drawing.motion->leftover[vertex + k]));
        block.add_gouge_mm(static_cast<float>(drawing.motion->gouge[vertex + k]));
      }
    }
    vertex += piece.vertices.size();
  }
  return block.slope_deg_size() == 0 || emit(std::move(block));
}

bool EmitPathBlocks(const JobResult& result, const std::function<bool(v1::PathBlock)>& emit) {
  const Toolpath& toolpath = result.posted;
  const Vec3 tip_offset = result.program_zero + Vec3(0.0, 0.0, toolpath.ball_radius);
  BlockEmitter blocks(emit);
  for (std::size_t i = 0; i < toolpath.moves.size(); ++i) {
    const Move& move = toolpath.moves[i];
    v1::PathBlock* const block = blocks.Next();
    if (block == nullptr) return false;
    Add(move.to - tip_offset, *block->mutable_tip_mm());
    block->add_contact_patch_index(move.contact ? move.contact->patch.value : -1);
    if (move.contact) Add(move.contact->p - result.program_zero, *block->mutable_contact_mm());
    block->add_kind(ToProto(move.kind));
    block->add_pass_kind(move.pass >= 0
                             ? ToProto(result.motion.passes[static_cast<std::size_t>(move.pass)].kind)
                             : v1::PASS_KIND_UNSPECIFIED);
    block->add_region_id(move.region.value);
    block->add_pass_index(move.pass);
    block->add_feed_mm_per_min(move.kind == MoveKind::kRapid ? 0.0f : static_cast<float>(move.feed));
    block->add_seconds(static_cast<float>(result.posted_seconds[i]));
    block->add_line(result.posted_lines[i]);
    if (move.arc && i > 0) {
      AddArc(*move.arc, {toolpath.moves[i - 1].to, move.to}, tip_offset, *block);
    } else {
      block->add_arc_plane(v1::ARC_PLANE_UNSPECIFIED);
    }
  }
  return blocks.Flush();
}

bool EmitPathBlocks(const ProgramMotion& motion, const std::function<bool(v1::PathBlock)>& emit) {
  double top = -kInfinity;
  for (const ProgramMove& move : motion.moves) {
    if (!move.from_above) top = std::max(top, move.from.z());
    if (!move.to_above) top = std::max(top, move.to.z());
  }
  if (!std::isfinite(top)) top = 0.0;  // nothing moves below machine zero
  const auto drawn = [&](const Vec3& p, bool above) { return above ? Vec3(p.x(), p.y(), top) : p; };
  BlockEmitter blocks(emit);
  const auto add = [&](const ProgramMove& move, const Vec3& to, double length) {
    v1::PathBlock* const block = blocks.Next();
    if (block == nullptr) return false;
    const bool rapid = move.kind == ProgramMove::Kind::kRapid;
    Add(to, *block->mutable_tip_mm());
    block->add_kind(rapid ? v1::MOVE_KIND_RAPID : v1::MOVE_KIND_CUT);
    block->add_feed_mm_per_min(rapid ? 0.0f : static_cast<float>(move.feed));
    const double speed = rapid ? kAssumedRapid : move.feed;
    block->add_seconds(length > 0.0 && speed > 0.0 ? static_cast<float>(60.0 * length / speed) : 0.0f);
    block->add_line(move.line);
    block->add_arc_plane(v1::ARC_PLANE_UNSPECIFIED);
    return true;
  };
  bool begun = false;
  for (const ProgramMove& move : motion.moves) {
    const Vec3 from = drawn(move.from, move.from_above), to = drawn(move.to, move.to_above);
    if (!begun && !add(move, from, 0.0)) return false;
    begun = true;
    if (!add(move, to, (to - from).norm())) return false;
  }
  return blocks.Flush();
}

}  // namespace patchmill
