#include "import/occt/iges_labels.h"

#include <array>
#include <utility>
#include <vector>

#include <IGESData_ColorEntity.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <IGESGeom_BoundedSurface.hxx>
#include <IGESGeom_CurveOnSurface.hxx>
#include <IGESGeom_TrimmedSurface.hxx>
#include <IGESGraph_Color.hxx>
#include <IGESSolid_Face.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <absl/strings/str_cat.h>

#include "import/occt/label_map.h"
#include "import/occt/text.h"

namespace patchmill {
namespace {

std::optional<std::uint32_t> RgbOf(const IGESData_IGESEntity& entity) {
  if (const auto own = As<IGESGraph_Color>(entity.Color())) {
    double red = 0.0, green = 0.0, blue = 0.0;
    own->RGBIntensity(red, green, blue);  // percent
    return PackRgb(red / 100.0, green / 100.0, blue / 100.0);
  }
  // Colour numbers 1 to 8.
  constexpr std::array<std::uint32_t, 8> kColours = {0x000000, 0xFF0000, 0x00FF00, 0x0000FF,
                                                     0xFFFF00, 0xFF00FF, 0x00FFFF, 0xFFFFFF};
  const int rank = entity.RankColor();
  if (rank < 1 || rank > static_cast<int>(kColours.size())) return std::nullopt;
  return kColours[static_cast<std::size_t>(rank - 1)];
}

// Whether a border has curves: some systems write an empty one for a point on a face.
bool HasCurves(const Handle(IGESGeom_CurveOnSurface) & border) {
  return !border.IsNull() && (!border->CurveUV().IsNull() || !border->Curve3D().IsNull());
}

int LoopCount(const Entity& entity) {
  if (const auto trimmed = As<IGESGeom_TrimmedSurface>(entity)) {
    int count = trimmed->HasOuterContour() && HasCurves(trimmed->OuterContour()) ? 1 : 0;
    for (int k = 1; k <= trimmed->NbInnerContours(); ++k)
      count += HasCurves(trimmed->InnerContour(k)) ? 1 : 0;
    return count;
  }
  if (const auto bounded = As<IGESGeom_BoundedSurface>(entity)) return bounded->NbBoundaries();
  if (const auto face = As<IGESSolid_Face>(entity)) return face->NbLoops();
  return 0;
}

bool IsFace(const IGESData_IGESEntity& entity) {
  const int type = entity.TypeNumber();
  if (type == 143 || type == 144 || type == 510) return true;
  // Surfaces that stand for themselves.
  const bool surface = type == 114 || type == 118 || type == 120 || type == 122 || type == 128 || type == 140;
  return surface && entity.SubordinateStatus() == 0;
}

}  // namespace

void ReadIgesLabels(IGESControl_Reader& reader, CadFile& file) {
  const Handle(IGESData_IGESModel) model = reader.IGESModel();
  const auto number_of = [&](const Entity& entity) { return std::int64_t{2} * model->Number(entity) - 1; };
  const auto label_of = [&](const Entity& entity) {
    ShapeLabel label;
    const auto own = As<IGESData_IGESEntity>(entity);
    label.entity = number_of(entity);
    if (own->HasName()) label.name = TextOf(own->NameValue());
    if (label.name.empty() && own->HasShortLabel()) label.name = TextOf(own->ShortLabel());
    if (own->DefLevel() == IGESData_DefOne && own->Level() > 0) label.layer = absl::StrCat(own->Level());
    label.rgb = RgbOf(*own);
    label.loop_count = LoopCount(entity);
    return label;
  };
  LabelShapes(
      *reader.WS()->TransferReader()->TransientProcess(), label_of,
      [](const Entity& entity) { return !As<IGESData_IGESEntity>(entity).IsNull(); }, file.labels);
  std::vector<std::pair<std::int64_t, bool>> faces;
  int hidden = 0;
  for (int k = 1; k <= model->NbEntities(); ++k) {
    const auto entity = As<IGESData_IGESEntity>(model->Value(k));
    if (entity.IsNull() || !IsFace(*entity)) continue;
    const bool visible = entity->BlankStatus() == 0;
    hidden += visible ? 0 : 1;
    faces.emplace_back(number_of(entity), visible);
  }
  if (hidden > 0) file.skipped["hidden faces"] = hidden;
  file.lost_faces = LostFaces(faces, file);
}

}  // namespace patchmill
