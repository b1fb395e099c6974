// Failures of Open CASCADE as text.
#pragma once

#include <string>

#include <Standard_Failure.hxx>
#include <Standard_Type.hxx>

namespace patchmill {

inline std::string TextOf(const Standard_Failure& failure) {
  std::string text = failure.DynamicType()->Name();
  if (const char* message = failure.GetMessageString(); message != nullptr && *message != '\0') {
    text += ": ";
    text += message;
  }
  return text;
}

}  // namespace patchmill
