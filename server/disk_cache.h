// Answers of jobs on disk, for a server that is started again. Used only where the operator names a folder.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <absl/status/statusor.h>

#include "server/answer.h"
#include "server/store.h"

namespace patchmill {

struct DiskCacheParams {
  std::string folder;
  std::int64_t limit_bytes = std::int64_t{1} << 30;  // of all files together
  std::chrono::seconds lifetime = std::chrono::hours(24 * 7);
};

// One file for each answer, readable by its owner alone. A file is written whole or not at all. A file that
// is damaged, or older than its lifetime, is removed and not used. A full or read-only disk costs the cache,
// never an answer. Any thread may call it; several servers may use one folder.
class DiskCache {
 public:
  // INVALID_ARGUMENT if the folder is none, or cannot be written. It is made if it does not exist.
  static absl::StatusOr<std::unique_ptr<DiskCache>> Open(const DiskCacheParams& params);

  // `from`: digest of the model that the answer was made from; may be empty. `share`: the most bytes that
  // the files of the caller may have together; beyond them its oldest files are removed.
  void Put(const StoreKey& key, const std::string& from, const Messages& messages,
           std::optional<std::int64_t> share = {});
  std::optional<Messages> Find(const StoreKey& key, const std::string& from);
  // Removes the answers of a caller that were made from a model.
  void ForgetModel(const std::string& caller, const std::string& from);

 private:
  explicit DiskCache(DiskCacheParams params) : params_(std::move(params)) {}
  std::string PathOf(const StoreKey& key, const std::string& from) const;
  // Removes old files, then the oldest of those whose names begin with `prefix`, until these have at most so
  // many bytes.
  void Prune(const std::string& prefix, std::int64_t limit_bytes);

  const DiskCacheParams params_;
  std::mutex mutex_;  // of Prune
};

}  // namespace patchmill
