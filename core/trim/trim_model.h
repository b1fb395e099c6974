// Trimmed faces as patches that lie on the faces' surfaces exactly.
//
// Borders are exact along iso-parametric lines, and on planes for lines, conic sections and splines.
// Elsewhere the border of the patches follows the edge within the border tolerance [trimming].
#pragma once

#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "core/base/diagnostic.h"
#include "core/base/run_context.h"
#include "core/brep/brep_model.h"
#include "core/network/patch_model.h"

namespace patchmill {

struct TrimParams {
  double border_tolerance = 1e-4;    // mm, >= 1e-7
  std::vector<FaceId> skipped = {};  // a box that holds the face stands in the place of each
};

// One face of the file after trimming.
struct TrimmedFace {
  int first_patch = 0;  // in TrimmedModel::model
  int patch_count = 0;  // 0: lost; a finding says why
  double area = 0.0;    // mm^2, of the patches; 0 for a skipped face
  double gap = 0.0;     // mm, largest distance of the face's edges from its surface
  // mm, largest distance of the patches' border from the edges' feet on the surface, and of the edges from
  // those of the file.
  double border_error = 0.0;
  double surface_error = 0.0;  // mm, by how much its surface may differ from the file's; 0: it is the file's
};

struct TrimmedModel {
  // Mm; u x v points out of the body. Its faces are those of the BrepModel, lost ones too, called "f1", "f2"
  // and so on; the patches of the twelfth are "f12", or "f12.1", "f12.2" and so on.
  // A skipped face has the six sides of a box that is larger by at least 1e-4 of the part's size.
  // The join tolerance follows from the gaps and border errors found.
  PatchModel model;
  std::vector<TrimmedFace> faces;                                     // as BrepModel::faces
  double largest_gap = 0.0, border_error = 0.0, surface_error = 0.0;  // of all faces
  // SURFACES_APPROXIMATED (info): which faces have a surface_error, and the largest. FACE_LOST (error):
  // the face has no patches. FACE_TOO_NARROW (warning): it has none, and its area is at most that of a
  // strip of half its border's length that is as wide as the border tolerance, 1e-4 mm at most.
  // FACE_AREA_DIFFERS, VOLUME_DIFFERS (error): patches and file disagree by more than 1e-4 of the area of
  // a face or the volume of a closed body, and by more than its border may be off. BORDER_COARSE
  // (warning): the border tolerance is not reached. GAP (warning): an edge lies farther from its surface
  // than the border tolerance; (error): by more than 0.05 mm and 0.002 of the part's size.
  Diagnostics findings;
};

// Parallel over faces; the result does not depend on the number of threads. Coordinates are rounded to 2^-40
// of the size of the part, so that the last bits of the reader do not matter. Cancelled, or no face at
// all (FAILED_PRECONDITION), is an error.
absl::StatusOr<TrimmedModel> TrimFaces(const BrepModel& part, const TrimParams& params,
                                       const RunContext& run);

}  // namespace patchmill
