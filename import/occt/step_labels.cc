#include "import/occt/step_labels.h"

#include <cmath>
#include <set>
#include <unordered_map>
#include <utility>

#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <STEPConstruct_Styles.hxx>
#include <StepBasic_Product.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_ProductDefinitionFormation.hxx>
#include <StepData_StepModel.hxx>
#include <StepRepr_PropertyDefinition.hxx>
#include <StepRepr_Representation.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepRepr_RepresentationRelationship.hxx>
#include <StepShape_ConnectedFaceSet.hxx>
#include <StepShape_FaceSurface.hxx>
#include <StepShape_ManifoldSolidBrep.hxx>
#include <StepShape_ShapeDefinitionRepresentation.hxx>
#include <StepShape_ShellBasedSurfaceModel.hxx>
#include <StepVisual_ColourRgb.hxx>
#include <StepVisual_Invisibility.hxx>
#include <StepVisual_InvisibleItem.hxx>
#include <StepVisual_LayeredItem.hxx>
#include <StepVisual_PreDefinedColour.hxx>
#include <StepVisual_PreDefinedItem.hxx>
#include <StepVisual_PresentationLayerAssignment.hxx>
#include <StepVisual_StyledItem.hxx>
#include <StepVisual_StyledItemTarget.hxx>
#include <TopExp_Explorer.hxx>
#include <TransferBRep.hxx>
#include <Transfer_Binder.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include "import/occt/label_map.h"
#include "import/occt/text.h"

namespace patchmill {
namespace {

std::optional<std::uint32_t> RgbOf(const Handle(StepVisual_Colour) & colour) {
  if (const auto rgb = As<StepVisual_ColourRgb>(colour))
    return PackRgb(rgb->Red(), rgb->Green(), rgb->Blue());
  const auto known = As<StepVisual_PreDefinedColour>(colour);
  if (known.IsNull() || known->GetPreDefinedItem().IsNull()) return std::nullopt;
  static const std::map<std::string, std::uint32_t> kColours = {
      {"red", 0xFF0000},     {"green", 0x00FF00}, {"blue", 0x0000FF},  {"yellow", 0xFFFF00},
      {"magenta", 0xFF00FF}, {"cyan", 0x00FFFF},  {"black", 0x000000}, {"white", 0xFFFFFF}};
  const auto found = kColours.find(TextOf(known->GetPreDefinedItem()->Name()));
  return found == kColours.end() ? std::nullopt : std::optional(found->second);
}

Entity StyledEntity(const StepVisual_StyledItem& styled) {
  const Entity item(styled.Item().get());
  return item.IsNull() ? styled.ItemAP242().Value() : item;
}

// Colours, layers and invisibility, by the entity that has them.
std::unordered_map<const Standard_Transient*, ShapeLabel> StylesOf(const StepData_StepModel& model,
                                                                   const STEPConstruct_Styles& styles) {
  std::unordered_map<const Standard_Transient*, ShapeLabel> labels;
  for (int k = 1; k <= model.NbEntities(); ++k) {
    const Entity& entity = model.Value(k);
    if (const auto styled = As<StepVisual_StyledItem>(entity)) {
      const Entity item = StyledEntity(*styled);
      if (item.IsNull()) continue;
      Handle(StepVisual_Colour) surface, border, curve, rendered;
      double transparency = 0.0;
      bool component = false;
      if (!styles.GetColors(styled, surface, border, curve, rendered, transparency, component)) continue;
      const Handle(StepVisual_Colour) colour = surface.IsNull() ? rendered : surface;
      if (const auto rgb = RgbOf(colour)) labels[item.get()].rgb = rgb;
    } else if (const auto layer = As<StepVisual_PresentationLayerAssignment>(entity)) {
      for (int i = 1; i <= layer->NbAssignedItems(); ++i) {
        const Entity item = layer->AssignedItemsValue(i).Value();
        if (!item.IsNull()) labels[item.get()].layer = TextOf(layer->Name());
      }
    } else if (const auto invisible = As<StepVisual_Invisibility>(entity)) {
      for (int i = 1; i <= invisible->NbInvisibleItems(); ++i) {
        const auto hidden = As<StepVisual_StyledItem>(invisible->InvisibleItemsValue(i).Value());
        if (hidden.IsNull()) continue;
        const Entity item = StyledEntity(*hidden);
        if (!item.IsNull()) labels[item.get()].hidden = true;
      }
    }
  }
  return labels;
}

// The product whose shape a representation is, through a few relations of representations.
std::string ProductName(const Interface_Graph& graph, const Entity& used, int depth) {
  for (Interface_EntityIterator it = graph.Sharings(used); it.More(); it.Next()) {
    const auto shape = As<StepShape_ShapeDefinitionRepresentation>(it.Value());
    if (shape.IsNull()) continue;
    const auto property = shape->Definition().PropertyDefinition();
    if (property.IsNull()) continue;
    const auto definition = property->Definition().ProductDefinition();
    if (definition.IsNull() || definition->Formation().IsNull()) continue;
    const auto product = definition->Formation()->OfProduct();
    if (product.IsNull()) continue;
    const std::string name = TextOf(product->Name());
    return name.empty() ? TextOf(product->Id()) : name;
  }
  if (depth == 0) return {};
  for (Interface_EntityIterator it = graph.Sharings(used); it.More(); it.Next()) {
    if (As<StepRepr_Representation>(it.Value()).IsNull() &&
        As<StepShape_ShellBasedSurfaceModel>(it.Value()).IsNull() &&
        As<StepRepr_RepresentationRelationship>(it.Value()).IsNull()) {
      continue;
    }
    Entity next = it.Value();
    if (const auto relation = As<StepRepr_RepresentationRelationship>(it.Value())) {
      next = relation->Rep1() == used ? relation->Rep2() : relation->Rep1();
    }
    if (next.IsNull()) continue;
    if (std::string name = ProductName(graph, next, depth - 1); !name.empty()) return name;
  }
  return {};
}

}  // namespace

void ReadStepLabels(STEPControl_Reader& reader, CadFile& file) {
  const Handle(StepData_StepModel) model = reader.StepModel();
  STEPConstruct_Styles styles(reader.WS());
  auto known = StylesOf(*model, styles);
  const auto label_of = [&](const Entity& entity) {
    ShapeLabel label;
    if (const auto found = known.find(entity.get()); found != known.end()) label = found->second;
    label.entity = model->IdentLabel(entity);
    const auto item = As<StepRepr_RepresentationItem>(entity);
    if (!item.IsNull()) label.name = TextOf(item->Name());
    if (label.name == "NONE") label.name.clear();
    if (const auto face = As<StepShape_FaceSurface>(entity)) label.loop_count = face->NbBounds();
    const bool body =
        !As<StepShape_ManifoldSolidBrep>(entity).IsNull() || !As<StepShape_ConnectedFaceSet>(entity).IsNull();
    if (body && label.name.empty()) label.name = ProductName(reader.WS()->Graph(), entity, 4);
    return label;
  };
  LabelShapes(
      *reader.WS()->TransferReader()->TransientProcess(), label_of,
      [](const Entity& entity) { return !As<StepRepr_RepresentationItem>(entity).IsNull(); }, file.labels);
  std::vector<std::pair<std::int64_t, bool>> faces;
  for (int k = 1; k <= model->NbEntities(); ++k) {
    if (As<StepShape_FaceSurface>(model->Value(k)).IsNull()) continue;
    faces.emplace_back(model->IdentLabel(model->Value(k)), true);
  }
  file.lost_faces = LostFaces(faces, file);
}

}  // namespace patchmill
