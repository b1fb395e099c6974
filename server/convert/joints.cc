#include "server/convert/joints.h"

namespace patchmill {

void AddJoints(const ContinuityReport& report,
               google::protobuf::RepeatedPtrField<v1::EdgeContinuity>* joints) {
  for (const EdgeContinuity& joint : report.edges) {
    v1::EdgeContinuity& to = *joints->Add();
    to.set_patch_index(joint.a.patch.value);
    to.set_edge(joint.a.edge);
    to.set_other_patch_index(joint.b.patch.value);
    to.set_other_edge(joint.b.edge);
    to.set_max_gap_mm(joint.max_gap);
    to.set_max_angle_deg(Degrees(joint.max_angle));
    to.set_max_curvature_gap_per_mm(joint.max_curvature_gap);
    to.set_max_curvature_per_mm(joint.max_curvature);
    to.set_part(joint.part);
  }
}

}  // namespace patchmill
