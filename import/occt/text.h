// Texts of CAD files as valid UTF-8.
#pragma once

#include <string>
#include <string_view>

#include <Standard_Handle.hxx>
#include <TCollection_HAsciiString.hxx>

namespace patchmill {

// Text that is not valid UTF-8 is taken for Latin-1. Control characters become spaces; spaces at both ends
// are dropped.
std::string ToUtf8(std::string_view text);

// Empty for null.
std::string TextOf(const Handle(TCollection_HAsciiString) & text);

}  // namespace patchmill
