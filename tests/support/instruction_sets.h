// The same question on every instruction set that this processor has.
#pragma once

#include "core/base/instruction_set.h"

namespace patchmill::testing {

// Everything runs on `set` while this lives.
class OnInstructionSet {
 public:
  explicit OnInstructionSet(InstructionSet set) : before_(UsedInstructionSet()) { UseInstructionSet(set); }
  ~OnInstructionSet() { UseInstructionSet(before_); }
  OnInstructionSet(const OnInstructionSet&) = delete;
  OnInstructionSet& operator=(const OnInstructionSet&) = delete;

 private:
  const InstructionSet before_;
};

}  // namespace patchmill::testing
