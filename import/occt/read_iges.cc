#include <array>
#include <string>

#include <BRep_Builder.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Static.hxx>
#include <TopoDS_Compound.hxx>
#include <absl/status/status.h>
#include <absl/strings/str_cat.h>
#include <sys/mman.h>
#include <unistd.h>

#include "core/base/status.h"
#include "import/occt/iges_labels.h"
#include "import/occt/readers.h"
#include "import/occt/text.h"

namespace patchmill {
namespace {

// Bytes in memory under a file name, as long as it lives.
class NamedBytes {
 public:
  explicit NamedBytes(std::string_view bytes) : file_(memfd_create("part", MFD_CLOEXEC)) {
    while (file_ >= 0 && !bytes.empty()) {
      const ssize_t written = write(file_, bytes.data(), bytes.size());
      if (written <= 0) {
        complete_ = false;
        return;
      }
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    complete_ = file_ >= 0;
  }
  ~NamedBytes() {
    if (file_ >= 0) close(file_);
  }
  NamedBytes(const NamedBytes&) = delete;
  NamedBytes& operator=(const NamedBytes&) = delete;

  bool complete() const { return complete_; }
  std::string name() const { return absl::StrCat("/proc/self/fd/", file_); }

 private:
  int file_;
  bool complete_ = false;
};

void ReadHeader(const IGESData_IGESModel& model, CadFile& file) {
  const IGESData_GlobalSection& global = model.GlobalSection();
  // By the number of the version, from 3 on.
  constexpr std::array<const char*, 9> kVersions = {"2.0", "3.0", "3.0", "4.0", "4.0",
                                                    "5.0", "5.1", "5.2", "5.3"};
  const int version = global.IGESVersion();
  const bool known = version >= 3 && version < 3 + static_cast<int>(kVersions.size());
  file.schema = known ? absl::StrCat("IGES ", kVersions[static_cast<std::size_t>(version - 3)]) : "IGES";
  file.unit = TextOf(global.UnitName());
  if (file.unit.empty()) {
    constexpr std::array<const char*, 12> kUnits = {"",  "INCH", "MM",  "",   "FT", "MI",
                                                    "M", "KM",   "MIL", "UM", "CM", "UIN"};
    const int flag = global.UnitFlag();
    if (flag >= 1 && flag < static_cast<int>(kUnits.size()))
      file.unit = kUnits[static_cast<std::size_t>(flag)];
  }
  file.written_by = TextOf(global.SystemId());
  if (file.written_by.empty()) file.written_by = TextOf(global.InterfaceVersion());
}

// Every surface that no other entity needs.
TopoDS_Shape SearchShapes(IGESControl_Reader& reader) {
  const Handle(IGESData_IGESModel) model = reader.IGESModel();
  TopoDS_Compound all;
  BRep_Builder builder;
  builder.MakeCompound(all);
  for (const int type : {144, 143, 128}) {
    for (int k = 1; k <= model->NbEntities(); ++k) {
      const auto entity = Handle(IGESData_IGESEntity)::DownCast(model->Value(k));
      if (entity.IsNull() || entity->TypeNumber() != type || entity->BlankStatus() != 0) continue;
      if (type == 128 && entity->SubordinateStatus() != 0) continue;
      reader.ClearShapes();
      if (!reader.TransferEntity(entity)) continue;
      if (const TopoDS_Shape shape = reader.OneShape(); !shape.IsNull()) builder.Add(all, shape);
    }
  }
  return all;
}

}  // namespace

absl::Status ReadIges(std::string_view content, CadFile& file) {
  IGESControl_Reader reader;
  SetReaderParameters();
  Interface_Static::SetIVal("read.iges.onlyvisible", 1);
  reader.SetReadVisible(true);
  const NamedBytes bytes(content);
  if (!bytes.complete()) return absl::ResourceExhaustedError("the file could not be kept in memory");
  if (reader.ReadFile(bytes.name().c_str()) != IFSelect_RetDone || reader.IGESModel().IsNull() ||
      reader.IGESModel()->NbEntities() == 0) {
    return absl::InvalidArgumentError("the file is no IGES file, or it is damaged");
  }
  ReadHeader(*reader.IGESModel(), file);
  const int roots = reader.NbRootsForTransfer();
  if (roots > 0) reader.TransferRoots();
  file.root_count = roots;
  file.shape = reader.OneShape();
  SearchWithoutRoots(file, [&reader] { return SearchShapes(reader); });
  ReadIgesLabels(reader, file);
  return absl::OkStatus();
}

}  // namespace patchmill
