// A canonical form of answers on the wire. Its bytes depend on numbers, codes and places, but not on the
// wording of messages.
#pragma once

#include <string>
#include <string_view>

#include <google/protobuf/message.h>

#include "patchmill/v1/report.pb.h"

namespace patchmill::testing {

// The blocks of a program, one a line, without comments and block numbers (N); one blank between words.
std::string MotionBlocks(std::string_view program);

// The report without texts (messages of findings, basis of the time), without stages and their seconds, and
// without size and digest of the program, which depend on its comments. A line of the program becomes the
// number of its block, from 1.
v1::Report CanonicalReport(v1::Report report, std::string_view program);

// Fields by their numbers, in a fixed order: a field that gets another name changes nothing.
std::string CanonicalBytes(const google::protobuf::Message& message);

}  // namespace patchmill::testing
