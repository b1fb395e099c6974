#include <istream>
#include <streambuf>

#include <BRep_Builder.hxx>
#include <HeaderSection_FileName.hxx>
#include <HeaderSection_FileSchema.hxx>
#include <STEPConstruct_ExternRefs.hxx>
#include <STEPControl_Reader.hxx>
#include <StepData_StepModel.hxx>
#include <StepShape_FaceSurface.hxx>
#include <StepShape_GeometricSet.hxx>
#include <StepShape_ManifoldSolidBrep.hxx>
#include <StepShape_ShellBasedSurfaceModel.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TopoDS_Compound.hxx>
#include <XSControl_WorkSession.hxx>
#include <absl/status/status.h>
#include <absl/strings/str_cat.h>

#include "core/base/status.h"
#include "import/occt/readers.h"
#include "import/occt/step_labels.h"
#include "import/occt/text.h"

namespace patchmill {
namespace {

// Reads from bytes that stay where they are.
class BytesBuffer : public std::streambuf {
 public:
  explicit BytesBuffer(std::string_view bytes) {
    char* begin = const_cast<char*>(bytes.data());  // never written to
    setg(begin, begin, begin + bytes.size());
  }
};

void ReadHeader(STEPControl_Reader& reader, CadFile& file) {
  const Handle(StepData_StepModel) model = reader.StepModel();
  const auto schema = Handle(HeaderSection_FileSchema)::DownCast(
      model->HeaderEntity(STANDARD_TYPE(HeaderSection_FileSchema)));
  if (!schema.IsNull() && schema->NbSchemaIdentifiers() > 0) {
    file.schema = TextOf(schema->SchemaIdentifiersValue(1));
    // The object identifier behind the name says nothing that the name does not.
    file.schema = ToUtf8(std::string_view(file.schema).substr(0, file.schema.find('{')));
  }
  const auto name =
      Handle(HeaderSection_FileName)::DownCast(model->HeaderEntity(STANDARD_TYPE(HeaderSection_FileName)));
  if (!name.IsNull()) {
    file.written_by = TextOf(name->OriginatingSystem());
    if (file.written_by.empty()) file.written_by = TextOf(name->PreprocessorVersion());
  }
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.FileUnits(lengths, angles, solid_angles);
  for (const TCollection_AsciiString& unit : lengths) {
    const std::string text = ToUtf8(unit.ToCString());
    if (file.unit.find(text) == std::string::npos)
      absl::StrAppend(&file.unit, file.unit.empty() ? "" : ", ", text);
  }
}

int CountWord(std::string_view text, std::string_view word) {
  int count = 0;
  for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

// Every body and every face that no body has, where the file names no product.
TopoDS_Shape SearchShapes(STEPControl_Reader& reader) {
  const Handle(StepData_StepModel) model = reader.StepModel();
  TopoDS_Compound all;
  BRep_Builder builder;
  builder.MakeCompound(all);
  const auto take = [&](const Handle(Standard_Type) & kind) {
    for (int k = 1; k <= model->NbEntities(); ++k) {
      if (!model->Value(k)->IsKind(kind)) continue;
      reader.ClearShapes();
      if (!reader.TransferEntity(model->Value(k))) continue;
      if (const TopoDS_Shape shape = reader.OneShape(); !shape.IsNull()) builder.Add(all, shape);
    }
    return HasFace(all);
  };
  const bool bodies = take(STANDARD_TYPE(StepShape_ManifoldSolidBrep));
  const bool shells = take(STANDARD_TYPE(StepShape_ShellBasedSurfaceModel));
  const bool sets = take(STANDARD_TYPE(StepShape_GeometricSet));
  if (!bodies && !shells && !sets) take(STANDARD_TYPE(StepShape_FaceSurface));
  return all;
}

}  // namespace

absl::Status ReadStep(std::string_view content, CadFile& file) {
  STEPControl_Reader reader;
  SetReaderParameters();
  BytesBuffer buffer(content);
  std::istream stream(&buffer);
  if (reader.ReadStream("part", stream) != IFSelect_RetDone) {
    return absl::InvalidArgumentError("the file is no STEP file, or it is damaged");
  }
  ReadHeader(reader, file);
  const int tessellated =
      CountWord(content, "TRIANGULATED_FACE(") + CountWord(content, "TRIANGULATED_FACE (");
  if (tessellated > 0) file.skipped["tessellated faces"] = tessellated;

  const int roots = reader.NbRootsForTransfer();
  for (int k = 1; k <= roots; ++k) file.root_count += reader.TransferRoot(k) ? 1 : 0;
  file.shape = reader.OneShape();
  SearchWithoutRoots(file, [&reader] { return SearchShapes(reader); });
  STEPConstruct_ExternRefs references(reader.WS());
  if (references.LoadExternRefs()) {
    for (int k = 1; k <= references.NbExternRefs(); ++k) {
      if (const char* name = references.FileName(k); name != nullptr) {
        file.external_files.push_back(ToUtf8(name));
      }
    }
  }
  ReadStepLabels(reader, file);
  return absl::OkStatus();
}

}  // namespace patchmill
