// Which options of a job are set by none of some requests: an option that joins the contract needs a golden
// job.
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

  // "Operation.low_rapids", "EdgeRule.EDGE_RULE_ROLL": what a GenerateProgramRequest could have and none had;
  // without what the service does not have yet, what changes neither motion, regions nor report, and what
  // models are made of.
  std::vector<std::string> Missing() const;

 private:
  std::set<std::string> seen_;
};

}  // namespace patchmill::testing
