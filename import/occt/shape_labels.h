// What a file says of the faces and bodies of its shape: names, layers, colours, numbers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <NCollection_DataMap.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Shape.hxx>

namespace patchmill {

struct ShapeLabel {
  std::string name, layer;           // valid UTF-8
  std::optional<std::uint32_t> rgb;  // 0xRRGGBB
  std::int64_t entity = 0;           // STEP: the number after #; IGES: the number of the directory line
  bool hidden = false;               // the file says that it is not to be seen
  int loop_count = 0;                // as the file has it; 0 unknown
};

// Labels by shape, wherever the shape is placed and however it is turned.
class ShapeLabels {
 public:
  void Set(const TopoDS_Shape& shape, const ShapeLabel& label) { map_.Bind(Bare(shape), label); }
  // Null where nothing is known.
  const ShapeLabel* Find(const TopoDS_Shape& shape) const { return map_.Seek(Bare(shape)); }

 private:
  static TopoDS_Shape Bare(const TopoDS_Shape& shape) { return shape.Located(TopLoc_Location()); }
  NCollection_DataMap<TopoDS_Shape, ShapeLabel, TopTools_ShapeMapHasher> map_;
};

}  // namespace patchmill
