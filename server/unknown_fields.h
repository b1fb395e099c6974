// A field from a newer contract is refused, never silently ignored: it might be a clamp.
#pragma once

#include <string>

#include <google/protobuf/message.h>

namespace patchmill {

// Path of the first message with a field this version does not know, with its number ("job.setup.#12"); empty
// when there is none. Cost: one visit of every message, packed numbers not touched.
std::string UnknownField(const google::protobuf::Message& message);

}  // namespace patchmill
