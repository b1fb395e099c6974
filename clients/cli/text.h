// Answers in words, for people.
#pragma once

#include <string>
#include <string_view>

#include <google/protobuf/message.h>

#include "patchmill/v1/diagnostic.pb.h"
#include "patchmill/v1/lines.pb.h"
#include "patchmill/v1/report.pb.h"

namespace patchmill::cli {

// An enum's value without its prefix: "COMPLETE".
std::string Short(v1::Outcome value);
std::string Short(v1::UnreachableReason value);
std::string Short(v1::CheckState value);
std::string Short(v1::LineKind value);
std::string Short(v1::BorderKind value);
std::string Short(v1::RegionKind value);
std::string Short(v1::Slope value);
std::string Short(v1::Strategy value);

// "WARNING OPEN_EDGE patch 3: ...".
std::string Line(const v1::Diagnostic& finding);
int CountErrors(const google::protobuf::RepeatedPtrField<v1::Diagnostic>& findings);
// "X 1.000 Y 2.000 Z 3.000".
std::string Line(const v1::Point3& point);
std::string Line(const v1::Place& place);
// "12.3 % of the area (UNDERCUT 10.1 %, CONCAVE 2.2 %)": how much is not reached; "nothing" when all of it
// is.
std::string UncutShare(const v1::Report& report);
// "UNDERCUT 12.3 mm2, CONCAVE 4.5 mm2"; empty when nothing is left out.
std::string UnreachableLine(const v1::Report& report);

// "52 / 20 / 15 / 12 / 1 % of it with up to 0.25 / 0.5 / 0.75 / 1 / more scallops"; empty when nothing was
// judged.
std::string SpreadLine(const v1::Report& report);
// "regions 3 (12.3 mm2), 5 (4.5 mm2)"; empty when none was switched off.
std::string SkippedLine(const v1::Report& report);

// What the contract takes as text: at most `most` bytes of UTF-8, cut between characters; bytes that are none
// become '?'.
std::string WireText(std::string_view text, std::size_t most);

// The proto's own field names, zeros printed, one field a line.
std::string Json(const google::protobuf::Message& message);
// What is set only, on one line: for models.
std::string ShortJson(const google::protobuf::Message& message);

}  // namespace patchmill::cli
