// Requests the service tests start from: small, complete, and each valid as it is.
#pragma once

#include <cmath>
#include <initializer_list>
#include <string>

#include "patchmill/v1/model_service.pb.h"
#include "patchmill/v1/toolpath_service.pb.h"

namespace patchmill::testing {

// A bicubic bump of `height` over [0, size]^2, flat along its border.
inline v1::PatchModel Bump(double size = 12.0, double height = 2.0) {
  v1::PatchModel model;
  model.set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  v1::Patch& patch = *model.add_patches();
  patch.set_id("bump");
  v1::BezierPatch& bezier = *patch.mutable_bezier();
  bezier.set_degree_u(3);
  bezier.set_degree_v(3);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const bool inner = i % 3 != 0 && j % 3 != 0;
      for (const double x : {size * i / 3.0, size * j / 3.0, inner ? height : 0.0}) bezier.add_points(x);
    }
  }
  return model;
}

// The same with a hill for u < 1/2 and a pit for u > 1/2: a mountain and a basin.
inline v1::PatchModel HillAndPit(double size = 24.0, double height = 4.0) {
  v1::PatchModel model = Bump(size, height);
  v1::BezierPatch& bezier = *model.mutable_patches(0)->mutable_bezier();
  for (const int j : {1, 2}) bezier.set_points(3 * (4 * 2 + j) + 2, -height);
  return model;
}

inline v1::Tool BallTool(double diameter = 6.0) {
  v1::Tool tool;
  tool.set_number(1);
  tool.mutable_ball_end()->set_diameter_mm(diameter);
  tool.set_spindle_rpm(12000);
  tool.set_feed_mm_per_min(1200);
  tool.set_plunge_feed_mm_per_min(400);
  return tool;
}

inline v1::Job BumpJob(double size = 12.0) {
  v1::Job job;
  *job.mutable_source()->mutable_model() = Bump(size);
  v1::Operation& op = *job.add_operations();
  *op.mutable_tool() = BallTool();
  op.set_scallop_mm(0.05);
  op.set_tolerance_mm(0.02);
  op.mutable_heights()->set_floor_z_mm(
      -1.0);  // low enough to finish the slopes at the border: nothing is out of reach
  return job;
}

inline v1::GenerateProgramRequest BumpRequest(double size = 12.0) {
  v1::GenerateProgramRequest request;
  *request.mutable_job() = BumpJob(size);
  return request;
}

// Minutes of work, for cancels and deadlines: a kilometre of fine lines.
inline v1::GenerateProgramRequest LongRequest() {
  v1::GenerateProgramRequest request = BumpRequest(380.0);
  v1::Operation& op = *request.mutable_job()->mutable_operations(0);
  op.mutable_tool()->mutable_ball_end()->set_diameter_mm(2.0);
  op.set_scallop_mm(0.002);
  op.set_tolerance_mm(0.01);
  return request;
}

}  // namespace patchmill::testing
