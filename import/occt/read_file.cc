#include "import/occt/read_file.h"

#include <new>

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <absl/status/status.h>
#include <absl/strings/str_cat.h>

#include "core/base/status.h"
#include "import/occt/failures.h"
#include "import/occt/readers.h"

namespace patchmill {
namespace {

int Count(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind, TopAbs_ShapeEnum outside_of) {
  int count = 0;
  for (TopExp_Explorer it(shape, kind, outside_of); it.More(); it.Next()) ++count;
  return count;
}

void CountLooseParts(CadFile& file) {
  const int wires = Count(file.shape, TopAbs_WIRE, TopAbs_FACE) + Count(file.shape, TopAbs_EDGE, TopAbs_WIRE);
  const int points = Count(file.shape, TopAbs_VERTEX, TopAbs_EDGE);
  if (wires > 0) file.skipped["wires"] += wires;
  if (points > 0) file.skipped["points"] += points;
}

}  // namespace

absl::StatusOr<CadFile> ReadCadFile(std::string_view content, std::string_view format) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  try {
    CadFile file;
    if (format == "step") {
      PM_RETURN_IF_ERROR(ReadStep(content, file));
    } else if (format == "iges") {
      PM_RETURN_IF_ERROR(ReadIges(content, file));
    } else {
      return absl::InvalidArgumentError("the format must be \"step\" or \"iges\"");
    }
    CountLooseParts(file);
    file.sewing = SewLooseFaces(file.shape, file.labels);
    return file;
  } catch (const Standard_Failure& failure) {
    return absl::InvalidArgumentError(absl::StrCat("the reader failed on this file: ", TextOf(failure)));
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError("not enough memory for this file");
  }
}

}  // namespace patchmill
