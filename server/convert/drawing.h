// What a client draws -> messages: triangles and the paths of a program, in blocks.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cam/plan/drawing.h"
#include "cam/plan/job.h"
#include "cam/toolpath/toolpath.h"
#include "patchmill/v1/toolpath.pb.h"
#include "server/errors.h"

namespace patchmill {

// The chord of a request's triangles, mm.
double ReadChord(double asked, FieldErrors& errors);

// Face.id of each patch, or its own id, or empty.
std::vector<std::string> PatchNames(const PatchModel& model);

// Emits the triangles, several pieces in a block. `zero` is program zero in the placed frame, mm. Stops and
// returns false if `emit` returns false.
bool EmitMesh(const SurfaceDrawing& drawing, const Surface& surface, const Vec3& zero,
              const std::function<bool(v1::MeshBlock)>& emit);

// Emits the posted motion of a job that has a program.
bool EmitPathBlocks(const JobResult& result, const std::function<bool(v1::PathBlock)>& emit);

// Emits the motion of a program's text. Ends at machine zero, whose height is unknown, are drawn at the
// highest tip of the motion.
bool EmitPathBlocks(const ProgramMotion& motion, const std::function<bool(v1::PathBlock)>& emit);

}  // namespace patchmill
