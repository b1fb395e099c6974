// The reference parts and jobs of tests/bench/README.md, made once each and kept.
#pragma once

#include "cam/plan/plan.h"

namespace patchmill::bench {

enum class Part { kTwoHills, kBumpy, kTeapot, kToroidalTet };

// Two hills and bumpy cover [0,100]^2; the teapot lies at scale 54.8, up y; the toroidal tetrahedron at scale
// 40. A file that cannot be read ends the program with its name.
const PatchModel& ModelOf(Part part);
Placement PlacementOf(Part part);
const Surface& SurfaceOf(Part part);

// D 6. Two hills: scallop 0.01, tolerance 0.005. Teapot: scallop 0.02, tolerance 0.01.
Job JobOf(Part part);

// Sets the process's peak memory back to what it uses now (Linux), and reads it, in MB (1e6 bytes). Zero
// where the system does not tell.
void ResetPeakMemory();
double PeakMemory();

}  // namespace patchmill::bench
