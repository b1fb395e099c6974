// Answers of jobs that are kept: in the store, and on disk where the operator wants that.
#pragma once

#include <memory>
#include <string>

#include "server/answer.h"
#include "server/disk_cache.h"
#include "server/store.h"

namespace patchmill {

class KeptAnswers {
 public:
  // `store` outlives it. `disk` may be null.
  KeptAnswers(Store& store, std::unique_ptr<DiskCache> disk) : store_(store), disk_(std::move(disk)) {}

  // `from`: digest of the model that the request names; empty if it names none.
  void Put(const StoreKey& key, const std::string& from, Messages messages);
  std::shared_ptr<const Messages> Find(const StoreKey& key, const std::string& from);
  // Forgets a model of a caller, and all answers that were made from it. False: there was no such model.
  bool ForgetModel(const std::string& caller, const std::string& digest);

 private:
  Store& store_;
  const std::unique_ptr<DiskCache> disk_;
};

}  // namespace patchmill
