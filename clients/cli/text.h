// Answers as text for users.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <google/protobuf/message.h>
#include <google/protobuf/struct.pb.h>

#include "patchmill/v1/diagnostic.pb.h"
#include "patchmill/v1/lines.pb.h"
#include "patchmill/v1/model.pb.h"
#include "patchmill/v1/region.pb.h"
#include "patchmill/v1/report.pb.h"
#include "patchmill/v1/setup.pb.h"

namespace patchmill::cli {

// Name of an enum value without its prefix: "COMPLETE".
std::string Short(v1::Outcome value);
std::string Short(v1::UnreachableReason value);
std::string Short(v1::CheckState value);
std::string Short(v1::LineKind value);
std::string Short(v1::BorderKind value);
std::string Short(v1::RegionKind value);
std::string Short(v1::Slope value);
std::string Short(v1::Strategy value);
std::string Short(v1::SurfaceKind value);  // "cylinder"
std::string Short(v1::UpAxis value);       // "-z", as --up takes it

// Names come from files. No character in them may move the cursor of a terminal or begin a line: control
// characters become "\\x0a".
std::string Printable(const std::string& text);

// "WARNING OPEN_EDGE patch 3: ...".
std::string Line(const v1::Diagnostic& finding);
// Findings as lines: errors first, then warnings, then the rest. Of a code that is no error and occurs more
// than five times, three stand for all, with the number of the others, unless `all`.
std::vector<std::string> FindingLines(const google::protobuf::RepeatedPtrField<v1::Diagnostic>& findings,
                                      bool all);
int CountErrors(const google::protobuf::RepeatedPtrField<v1::Diagnostic>& findings);
// mm, along the line; from the last point to the first if it is closed.
double LengthOf(const v1::BorderLine& line);
// "X 1.000 Y 2.000 Z 3.000".
std::string Line(const v1::Point3& point);
std::string Line(const v1::Place& place);
// Share of the area that is unreachable: "12.3 % of the area (UNDERCUT 10.1 %, CONCAVE 2.2 %)", or "nothing".
std::string UncutShare(const v1::Report& report);
// "UNDERCUT 12.3 mm2 (up to 0.123 mm stays), CONCAVE ..."; empty if everything is reachable.
std::string UnreachableLine(const v1::Report& report);

// "52 / 20 / 15 / 12 / 1 % of the surface with up to 0.25 / 0.5 / 0.75 / 1 / more scallops left"; empty if
// the finish was not checked.
std::string SpreadLine(const v1::Report& report);
// "regions 3 (12.3 mm2), 5 (4.5 mm2)"; empty if no region is switched off.
std::string SkippedLine(const v1::Report& report);

// `text` as the contract allows it: at most `most` bytes of valid UTF-8, cut between characters. Bytes that
// are no UTF-8 become '?'.
std::string WireText(std::string_view text, std::size_t most);

// JSON with the field names of the proto, one field a line. Zeros are printed.
std::string Json(const google::protobuf::Message& message);
// JSON on one line with only the fields that are set. For models.
std::string ShortJson(const google::protobuf::Message& message);
// JSON on one line, members sorted by name; empty if a text in it is not UTF-8.
std::string SortedJson(const google::protobuf::Struct& object);

}  // namespace patchmill::cli
