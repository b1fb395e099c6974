// Finds options of a job that no request of a set uses. An option that is added to the contract needs a
// golden job.
#pragma once

#include <set>
#include <string>
#include <vector>

#include <google/protobuf/message.h>

namespace patchmill::testing {

class CoveredFields {
 public:
  // Notes every field that is set anywhere in the message, and every value of an enumeration in it.
  void Add(const google::protobuf::Message& message);

  // Fields and values that a GenerateProgramRequest can have and none had, such as "Operation.low_rapids" or
  // "EdgeRule.EDGE_RULE_ROLL". Left out are fields that are not available yet, those that change neither
  // motion, regions nor report, and those of models.
  std::vector<std::string> Missing() const;

 private:
  std::set<std::string> seen_;
};

}  // namespace patchmill::testing
