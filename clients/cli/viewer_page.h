// The template of the 3-D page (clients/viewer), built into the program.
#pragma once

#include <string_view>

namespace patchmill::cli {

// HTML with places for the scene and its data. Empty if the program was built without Node.js.
std::string_view ViewerPage();

}  // namespace patchmill::cli
