// Finds fields of a newer contract. They are refused and never ignored silently: one might be a clamp.
#pragma once

#include <string>

#include <google/protobuf/message.h>

namespace patchmill {

// Path of the first field that this version does not know, with its number ("job.setup.#12"). Empty if there
// is none. Cost: one visit of every message; packed numbers are not visited.
std::string UnknownField(const google::protobuf::Message& message);

}  // namespace patchmill
