// What an answer says on the wire, in bytes that are the same as long as it says the same: numbers, codes and
// places count, how they are put into words does not.
#pragma once

#include <string>
#include <string_view>

#include <google/protobuf/message.h>

#include "patchmill/v1/report.pb.h"

namespace patchmill::testing {

// The blocks of a program, one a line, without comments and block numbers (N); one blank between words.
std::string MotionBlocks(std::string_view program);

// The report without texts (messages of findings, what the time is made of), without stages and their
// seconds, and without what follows from the comments of the program: its size and digest. A line of the
// program becomes the number of its block, from 1.
v1::Report CanonicalReport(v1::Report report, std::string_view program);

// Fields by their numbers, in a fixed order: a field that gets another name changes nothing.
std::string CanonicalBytes(const google::protobuf::Message& message);

}  // namespace patchmill::testing
