#include "import/occt/label_map.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <TopExp_Explorer.hxx>
#include <TransferBRep.hxx>
#include <Transfer_Binder.hxx>

namespace patchmill {

void LabelShapes(const Transfer_TransientProcess& transfer,
                 const std::function<ShapeLabel(const Handle(Standard_Transient) &)>& label_of,
                 const std::function<bool(const Handle(Standard_Transient) &)>& wanted, ShapeLabels& labels) {
  // A solid or a shell can be the result of several entities; the first one is the innermost.
  std::vector<std::pair<Handle(Standard_Transient), TopoDS_Shape>> larger;
  for (int k = 1; k <= transfer.NbMapped(); ++k) {
    const Handle(Standard_Transient)& entity = transfer.Mapped(k);
    if (!wanted(entity)) continue;
    const TopoDS_Shape shape = TransferBRep::ShapeResult(transfer.MapItem(k));
    if (shape.IsNull() || shape.ShapeType() > TopAbs_FACE) continue;
    if (shape.ShapeType() == TopAbs_FACE) {
      labels.Set(shape, label_of(entity));
    } else {
      larger.emplace_back(entity, shape);
    }
  }
  for (const auto& [entity, shape] : larger) {
    const ShapeLabel label = label_of(entity);
    const bool body = shape.ShapeType() == TopAbs_SOLID || shape.ShapeType() == TopAbs_SHELL;
    if (body) {
      if (labels.Find(shape) == nullptr) labels.Set(shape, label);
      continue;
    }
    for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
      if (labels.Find(it.Current()) == nullptr) labels.Set(it.Current(), label);
    }
  }
}

std::vector<std::int64_t> LostFaces(const std::vector<std::pair<std::int64_t, bool>>& faces,
                                    const CadFile& file) {
  std::set<std::int64_t> kept;
  for (TopExp_Explorer it(file.shape, TopAbs_FACE); it.More(); it.Next()) {
    if (const ShapeLabel* label = file.labels.Find(it.Current()); label != nullptr)
      kept.insert(label->entity);
  }
  std::vector<std::int64_t> lost;
  for (const auto& [number, visible] : faces) {
    if (visible && kept.count(number) == 0) lost.push_back(number);
  }
  std::sort(lost.begin(), lost.end());
  return lost;
}

std::uint32_t PackRgb(double red, double green, double blue) {
  const auto part = [](double x) {
    return static_cast<std::uint32_t>(std::lround(255.0 * std::clamp(x, 0.0, 1.0)));
  };
  return part(red) << 16 | part(green) << 8 | part(blue);
}

}  // namespace patchmill
