#include "tests/support/random_part.h"

#include <cmath>

namespace patchmill::testing {
namespace {

PatchModel RandomModel(Random& random) {
  const std::uint64_t seed = random.Bits();
  const bool coin = random.Int(2) == 0;
  const auto blend = coin ? GregoryPatch::Blend::kCorner : GregoryPatch::Blend::kEdge;
  switch (random.Int(16)) {
    case 0:
    case 1:
      return RandomBspline(seed, {.spans = 3, .size = 20.0});
    case 2:
      return RandomBspline(seed, {.spans = 3, .size = 20.0, .folds = true, .rational = coin});
    case 3:
      return Single(RandomBezier(seed, 1 + random.Int(6), 1 + random.Int(6), coin));
    case 4:
      return Single(RandomKnots(seed, 3, 1 + random.Int(3), coin));
    case 5:
      return Single(RandomGregory(seed, blend));
    case 6:
      return Single(RandomTriangle(seed, 1 + random.Int(5), coin));
    case 7:
      return Single(RandomBrown(seed, 3, 3));
    case 8:
      return Single(RandomGregoryTriangle(seed, blend));
    case 9:
      return Single(RandomLoftTriangle(seed, 3, coin));
    case 10:
      return Single(RandomG2Gregory(seed, 5));
    case 11:
      return Single(RandomHosaka(seed, 3, coin, true));
    case 12:
      return Block(random.Uniform(3, 8), random.Uniform(1, 8), 12.0);
    case 13:
      return TwoPlanes(random.Uniform(-1.5, 1.5), 10.0);
    case 14:
      return Torus(Vec3::Zero(), random.Uniform(3, 8), 3.0);
    default:
      return TwoSpheres(random.Uniform(3, 6), random.Uniform(2, 11));
  }
}

}  // namespace

RandomPart DrawPart(Random& random) {
  PatchModel model = RandomModel(random);
  const int more = random.Int(12);
  Eigen::Affine3d motion = Eigen::Affine3d::Identity();
  if (more == 0) model = Join({model, model});
  if (more == 1) model = Join({model, RandomModel(random)});
  if (more == 2) motion.scale(Vec3(1.0, std::pow(10.0, random.Uniform(-4.0, -1.0)), 1.0));
  if (more == 3) motion.rotate(Eigen::AngleAxisd(random.Uniform(0, kPi), random.Point(-1, 1).normalized()));
  if (more == 4) motion.translate(random.Point(-1e3, 1e3));
  const double scale = more == 5 ? std::pow(10.0, random.Uniform(-4.0, 4.0)) : 1.0;
  if (more >= 2 && more <= 5) model = Transformed(model, Eigen::Affine3d(Eigen::Scaling(scale) * motion));
  return {std::move(model), scale * std::pow(10.0, random.Uniform(-0.3, 0.8))};
}

}  // namespace patchmill::testing
