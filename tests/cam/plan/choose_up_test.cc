// The turn of a model by what it shows, and by the normal of a plane face, against closed forms.
#include "cam/plan/choose_up.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cam/plan/up_directions.h"
#include "core/base/error_details.h"
#include "core/base/status.h"
#include "core/network/control_points.h"
#include "tests/support/faced_box.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's
using ::testing::HasSubstr;

PatchModel Turned(PatchModel model, const Mat3& turn) {
  for (Patch& patch : model.patches) {
    for (Vec3& p : ControlPoints(patch.shape)) p = turn * p;
  }
  return model;
}

// Twice as wide as high: one side of it shows more than the others.
PatchModel Plate() {
  PatchModel model = FacedBox(10.0, 2);
  for (Patch& patch : model.patches) {
    for (Vec3& p : ControlPoints(patch.shape)) p.y() *= 2.0;
  }
  return model;
}

patchmill::Setup FaceUp(const std::string& id) {
  patchmill::Setup setup;
  setup.up_face = id;
  return setup;
}

absl::StatusOr<ChosenUp> Choose(const PatchModel& model, const patchmill::Setup& setup) {
  return ChooseUp(model, setup, RunContext());
}

TEST(ChooseUp, LeavesANamedAxisAlone) {
  patchmill::Setup setup;
  setup.placement.up = UpAxis::kNegY;
  const auto chosen = Choose(FacedBox(10.0, 1), setup);
  ASSERT_TRUE(chosen.ok());
  EXPECT_EQ(chosen->setup.placement.up, UpAxis::kNegY);
  EXPECT_FALSE(chosen->setup.placement.turn.has_value());
  EXPECT_TRUE(chosen->findings.empty());
}

// Bottom, lid, and the sides x = 0, x = 10, y = 0, y = 10.
TEST(ChooseUp, AFaceAcrossAnAxisIsThatAxis) {
  const UpAxis axes[] = {UpAxis::kNegZ, UpAxis::kZ, UpAxis::kNegX, UpAxis::kX, UpAxis::kNegY, UpAxis::kY};
  for (int k = 0; k < 6; ++k) {
    const std::string id = "f" + std::to_string(k + 1);
    const auto chosen = Choose(FacedBox(10.0, 2), FaceUp(id));
    ASSERT_TRUE(chosen.ok()) << chosen.status();
    EXPECT_EQ(chosen->setup.placement.up, axes[k]) << id;
    EXPECT_FALSE(chosen->setup.placement.turn.has_value()) << id;
    ASSERT_EQ(chosen->findings.size(), 1u);
    EXPECT_EQ(chosen->findings[0].code, "UP_CHOSEN");
    EXPECT_EQ(chosen->findings[0].where.face_id, id);
  }
}

TEST(ChooseUp, ASlantingFaceIsLevelAndOnTopAfterTheSmallestRotation) {
  for (const Vec3& axis : {Vec3(1, 2, 3), Vec3(-2, 1, 0.5), Vec3(0, 1, 0)}) {
    for (const double angle : {0.3, 1.2, 2.6, 3.1}) {
      const PatchModel model =
          Turned(FacedBox(10.0, 2), Eigen::AngleAxisd(angle, axis.normalized()).matrix());
      for (int k = 1; k <= 6; ++k) {
        const std::string id = "f" + std::to_string(k);
        const auto chosen = Choose(model, FaceUp(id));
        ASSERT_TRUE(chosen.ok()) << chosen.status();
        const PatchModel placed = Place(chosen->setup.placement, model);
        const double top = ControlBox(placed).max.z();
        for (const Patch& patch : placed.patches) {
          if (patch.face != FaceId(k - 1)) continue;
          for (const Vec3& p : ControlPoints(patch.shape)) EXPECT_NEAR(p.z(), top, 1e-13);
        }
        if (!chosen->setup.placement.turn) continue;  // the face lies across an axis
        const Mat3& turn = *chosen->setup.placement.turn;
        EXPECT_LE((turn * turn.transpose() - Mat3::Identity()).norm(), 1e-14);
        EXPECT_NEAR(turn.determinant(), 1.0, 1e-14);
        // The normal, which becomes the last row, lies within a quarter turn of +z: no rotation by a smaller
        // angle takes it there.
        const double cosine = turn(2, 2);
        if (cosine > 0.0) {
          EXPECT_NEAR(turn.trace(), 1.0 + 2.0 * cosine, 1e-13);
        }
      }
    }
  }
}

TEST(ChooseUp, ANormalJustOffMinusZIsTurnedWithoutLossOfDigits) {
  for (const double tilt : {1e-3, 1e-6, 1e-8, 3e-9}) {
    const PatchModel model = Turned(FacedBox(10.0, 1), Eigen::AngleAxisd(tilt, Vec3(0.6, 0.8, 0.0)).matrix());
    const auto chosen = Choose(model, FaceUp("f1"));
    ASSERT_TRUE(chosen.ok());
    ASSERT_TRUE(chosen->setup.placement.turn.has_value());
    const Mat3& turn = *chosen->setup.placement.turn;
    EXPECT_LE((turn * turn.transpose() - Mat3::Identity()).norm(), 1e-15);
    EXPECT_NEAR(turn.determinant(), 1.0, 1e-15);
  }
}

TEST(ChooseUp, AutomaticTakesTheBestOfTheTable) {
  for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
    const PatchModel model = Turned(Plate(), Eigen::AngleAxisd(kPi / 2.0, axis).matrix());
    patchmill::Setup setup;
    setup.up_auto = true;
    setup.placement.scale = 2.0;
    const auto chosen = Choose(model, setup);
    ASSERT_TRUE(chosen.ok()) << chosen.status();
    const auto table = MeasureUpDirections(SurfaceOf(model), Placement(), RunContext());
    ASSERT_TRUE(table.ok());
    EXPECT_EQ(chosen->setup.placement.up, BestUp(*table));
    ASSERT_EQ(chosen->findings.size(), 1u);
    EXPECT_THAT(chosen->findings[0].message,
                HasSubstr(std::string(Name(BestUp(*table))) + " points up, of the six axes"));
    EXPECT_THAT(chosen->findings[0].message,
                HasSubstr("800.0 mm2 look up, 0.0 of them are hidden, 1 level face;"));
  }
}

TEST(ChooseUp, SaysWhatIsNoPlaneFace) {
  PatchModel model = FacedBox(10.0, 1);
  const auto refused = [&](const patchmill::Setup& setup, const std::string& field, const std::string& text) {
    const absl::Status status = Choose(model, setup).status();
    EXPECT_EQ(FieldOf(status), field);
    EXPECT_THAT(FieldText(status), HasSubstr(text));
  };
  refused(FaceUp("f7"), "setup.up_face",
          "= \"f7\"; must be a plane face of the model, whose faces are f1 to f6");
  model.faces[2].kind = SurfaceKind::kCylinder;
  refused(FaceUp("f3"), "setup.up_face", "must be a plane face: it is a cylinder");
  model.faces.push_back(model.faces[0]);
  model.faces.back().id = "f7";
  refused(FaceUp("f7"), "setup.up_face", "must be a face that has patches");
  ControlPoints(model.patches[1].shape)[0].z() += 0.1;
  refused(FaceUp("f2"), "setup.up_face", "varies by");
  model.faces.clear();
  for (Patch& patch : model.patches) patch.face.reset();
  refused(FaceUp("f1"), "setup.up_face", "must be unset for a model without faces");
  patchmill::Setup automatic;
  automatic.up_auto = true;
  refused(automatic, "setup.up", "must have faces");
}

}  // namespace
}  // namespace patchmill
