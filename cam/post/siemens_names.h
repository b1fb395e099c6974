// Names of Siemens' language (keywords, addresses with = and calls) and what they mean to the reader of
// programs: tables, as data.
#pragma once

#include <string_view>

namespace patchmill {

enum class NameUse {
  kIgnored,      // moves nothing, and the path stays as it is
  kMerges,       // from here on the control smooths the path by what no word limits
  kEndsMerging,  // ends that
  kFrame,        // resets its frame if nothing follows, or zeros; else it is refused
  kTool,         // a length offset with rotary axes that are not judged
  kSpindle,      // stops the spindle at an angle
  kMachine,      // the coordinates of the line are those of the machine
  kZeroOnly,     // an address that does nothing at zero; else it is refused
  kRefused
};

struct SiemensName {
  std::string_view name;
  NameUse use = NameUse::kIgnored;
  std::string_view note = {};  // of kRefused and kZeroOnly: why, a sentence without its end
};

// nullptr: not known.
const SiemensName* FindKeyword(std::string_view name);
const SiemensName* FindAddress(std::string_view name);  // before an equals sign
const SiemensName* FindCall(std::string_view name);     // but CYCLE800 and CYCLE832

}  // namespace patchmill
