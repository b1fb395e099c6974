// The polynomial of a field has the field's sign, and what it proves is true.
#include "core/lines/line_forms.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/lines/line_fields.h"
#include "core/lines/zero_root.h"
#include "core/math/bernstein.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

double At(const BernsteinForm& form, double u, double v) {
  double bu[64], bv[64];
  AllBernstein(form.m, u, bu);
  AllBernstein(form.n, v, bv);
  double sum = 0.0;
  for (int i = 0; i <= form.m; ++i) {
    for (int j = 0; j <= form.n; ++j)
      sum += bu[i] * bv[j] * form.c[static_cast<std::size_t>(i * (form.n + 1) + j)];
  }
  return sum;
}

std::vector<Piece> Pieces() {
  std::vector<Piece> pieces;
  const auto add = [&](const PatchShape& shape) {
    for (Piece& piece : SplitIntoPieces(PatchId(0), shape)) pieces.push_back(std::move(piece));
  };
  add(RandomBezier(1, 3, 3, false));
  add(RandomBezier(2, 2, 5, false));
  add(RandomBezier(3, 1, 3, false));
  add(RandomBezier(4, 2, 2, true));
  add(RandomBezier(5, 3, 1, true));
  add(RandomBezier(6, 4, 3, true));
  add(RandomTriangle(7, 4, false));
  for (const Patch& patch : Torus(Vec3::Zero(), 20, 6, Half::kUpper).patches) add(patch.shape);
  return pieces;
}

TEST(LineForms, HaveTheSignsOfTheirFields) {
  Random random(11);
  const Vec3 axis = Vec3(0.3, -0.5, 0.8).normalized();
  const ZeroField fields[] = {
      SilhouetteField(),        SlopeField(Radians(40)),       ContourCurvatureField(),
      ContourField(1.0),        SlopeExtremumField(),          SilhouetteField(axis),
      SlopeField(0.9, axis),    ContourCurvatureField(axis),   ContourField(1.0, axis),
      SlopeExtremumField(axis), EyeSilhouetteField({9, 5, 30})};
  int compared = 0, formed = 0;
  for (const Piece& piece : Pieces()) {
    for (const ZeroField& field : fields) {
      const auto form = field.form(piece.net);
      if (!form) continue;  // degree beyond 30
      ++formed;
      for (int i = 0; i < 200; ++i) {
        const Vec2 q(random.Uniform(0, 1), random.Uniform(0, 1));
        const double value = Value(field, piece, q), of_form = At(*form, q.x(), q.y());
        if (std::abs(value) < 1e-7 || std::abs(of_form) <= form->slack) continue;
        ++compared;
        EXPECT_EQ(value > 0, of_form > 0) << q.transpose() << ": " << value << ", " << of_form;
      }
    }
  }
  EXPECT_GT(compared, 20000);
  EXPECT_GE(formed, 150);
}

TEST(LineForms, BrightnessKeepsItsSignWhereItsFormHasNoZero) {
  Random random(13);
  const ZeroField field = BrightnessField(0.8, Vec3(0.6, 0, 0.8));
  int proven = 0;
  for (const Piece& piece : Pieces()) {
    const auto whole = field.form(piece.net);
    ASSERT_TRUE(whole);
    const auto quarters = Quarters(*whole);
    for (int k = 0; k < 16; ++k) {
      const BernsteinForm part =
          Quarters(quarters[static_cast<std::size_t>(k / 4)])[static_cast<std::size_t>(k % 4)];
      if (SignOf(part) == FormSign::kOpen) continue;
      ++proven;
      const double u0 = 0.5 * (k / 8) + 0.25 * (k % 4 / 2), v0 = 0.5 * (k / 4 % 2) + 0.25 * (k % 2);
      const double first = Value(field, piece, {u0 + 0.1, v0 + 0.1});
      for (int i = 0; i < 30; ++i) {
        const Vec2 q(u0 + random.Uniform(0, 0.25), v0 + random.Uniform(0, 0.25));
        EXPECT_GT(first * Value(field, piece, q), 0.0) << q.transpose();
      }
    }
  }
  EXPECT_GT(proven, 50);
}

TEST(LineForms, QuartersAreTheSamePolynomial) {
  const Piece piece = Pieces()[0];
  const BernsteinForm form = *ContourCurvatureForm(piece.net);
  const auto quarters = Quarters(form);
  double largest = 0.0;
  for (const double c : form.c) largest = std::max(largest, std::abs(c));
  for (int q = 0; q < 4; ++q) {
    for (const double u : {0.0, 0.3, 1.0}) {
      for (const double v : {0.0, 0.6, 1.0}) {
        EXPECT_NEAR(At(quarters[static_cast<std::size_t>(q)], u, v),
                    At(form, 0.5 * (u + q / 2), 0.5 * (v + q % 2)), 1e-13 * largest);
      }
    }
  }
}

TEST(LineForms, ProofsHoldOnSubRectangles) {
  // What SignOf and IsGraph claim of a quarter of a quarter, dense samples must not contradict.
  int signs = 0, graphs = 0;
  for (const Piece& piece : Pieces()) {
    for (const BernsteinForm& half : Quarters(*ContourCurvatureForm(piece.net))) {
      for (const BernsteinForm& form : Quarters(half)) {
        constexpr int n = 12;
        const FormSign sign = SignOf(form);
        const bool graph = sign == FormSign::kOpen && IsGraph(form);
        signs += sign == FormSign::kPositive || sign == FormSign::kNegative;
        graphs += graph;
        for (int i = 0; i <= n; ++i) {
          int along_u = 0, along_v = 0;
          for (int j = 0; j <= n; ++j) {
            const double x = At(form, double(i) / n, double(j) / n);
            if (sign == FormSign::kPositive) {
              EXPECT_GT(x, 0.0);
            }
            if (sign == FormSign::kNegative) {
              EXPECT_LT(x, 0.0);
            }
            if (j == n) break;
            along_v += x * At(form, double(i) / n, double(j + 1) / n) < 0;
            along_u +=
                At(form, double(j) / n, double(i) / n) * At(form, double(j + 1) / n, double(i) / n) < 0;
          }
          // A graph over one of the parameters: lines along the other meet it once. Sides: once each.
          if (graph && (i == 0 || i == n)) {
            EXPECT_LE(along_u, 1);
            EXPECT_LE(along_v, 1);
          }
        }
      }
    }
  }
  EXPECT_GT(signs, 20);
  EXPECT_GT(graphs, 20);
}

TEST(LineForms, PlanesAreZeroNotNoise) {
  const Piece piece = SplitIntoPieces(PatchId(0), Plane(20, 3, 0.3, 0.1).patches[0].shape)[0];
  EXPECT_EQ(SignOf(*ContourCurvatureForm(piece.net)), FormSign::kZero);
  EXPECT_EQ(SignOf(*TurnForm(piece.net)), FormSign::kPositive);
  EXPECT_EQ(SignOf(*SlopeForm(piece.net, std::cos(Radians(10)))), FormSign::kNegative);
  EXPECT_EQ(SignOf(*SlopeForm(piece.net, std::cos(Radians(20)))), FormSign::kPositive);
}

TEST(LineForms, TooHighDegreesHaveNone) {
  const auto net = [](int degree, bool rational) {
    const PatchShape shape = RandomBezier(1, degree, 2, rational);
    return SplitIntoPieces(PatchId(0), shape)[0].net;
  };
  EXPECT_FALSE(ContourCurvatureForm(net(7, false)));
  EXPECT_FALSE(SlopeForm(net(6, true), 0.7));
  EXPECT_FALSE(SlopeExtremumForm(net(5, false)));
  EXPECT_FALSE(EyeForm(net(11, false), Vec3::Zero()));
}

}  // namespace
}  // namespace patchmill
