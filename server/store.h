// What the server keeps between calls: models that were uploaded, CAD files that were read, surfaces that
// were built, networks that were joined, answers of jobs. One store with one limit of memory: what nobody has
// used for longest is forgotten first.
#pragma once

#include <any>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>

namespace patchmill {

// What a value of the store is.
enum class Stored { kModel, kImport, kSurface, kJoined, kAnswer };

struct StoreKey {
  Stored kind = Stored::kModel;
  std::string caller;  // only this caller can find the value; empty: callers are not told apart
  std::string digest;  // 32 bytes
  friend auto operator<=>(const StoreKey&, const StoreKey&) = default;
};

// Any thread may call it. Values are shared and never change.
class Store {
 public:
  // The most bytes that the values of a caller may have; nothing: the whole limit.
  using Shares = std::function<std::optional<std::int64_t>(const std::string& caller)>;
  explicit Store(std::size_t limit_bytes, Shares share_of = {})
      : limit_(limit_bytes), share_of_(std::move(share_of)) {}

  // Keeps a value of about `bytes`, in place of one with the same key. False if it is too large: a model may
  // take the whole limit of its caller, any other value a quarter of it. A caller beyond its share loses
  // values of its own. `from` is the digest of the model that an answer
  // was made from.
  template <class T>
  bool Put(const StoreKey& key, std::shared_ptr<const T> value, std::size_t bytes, std::string from = {}) {
    return PutAny(key, std::move(value), bytes, std::move(from));
  }
  // The value with this key, or null. It counts as used.
  template <class T>
  std::shared_ptr<const T> Find(const StoreKey& key) {
    const std::any value = FindAny(key);
    const auto* found = std::any_cast<std::shared_ptr<const T>>(&value);
    return found == nullptr ? nullptr : *found;
  }
  // Forgets a model of a caller, and all surfaces, joined networks and answers that were made from it. False:
  // there was no such model.
  bool ForgetModel(const std::string& caller, const std::string& digest);

  struct Figures {
    std::size_t values = 0, bytes = 0, limit_bytes = 0;
    std::size_t found = 0, missed = 0, forgotten = 0;  // since the start
  };
  Figures figures() const;
  std::size_t limit_bytes() const { return limit_; }
  // The share of a caller, where it has one of its own.
  std::optional<std::int64_t> ShareOf(const std::string& caller) const;
  // Of the values of one caller.
  std::size_t LimitOf(const std::string& caller) const;

 private:
  struct Entry {
    StoreKey key;
    std::any value;
    std::size_t bytes = 0;
    std::string from;
  };
  using Entries = std::list<Entry>;

  bool PutAny(const StoreKey& key, std::any value, std::size_t bytes, std::string from);
  std::any FindAny(const StoreKey& key);
  void Erase(Entries::iterator entry);

  void Forget(Entries::iterator entry, Entries& forgotten);

  const std::size_t limit_;
  const Shares share_of_;
  mutable std::mutex mutex_;
  Entries entries_;  // used last comes first
  std::map<StoreKey, Entries::iterator> by_key_;
  std::map<std::string, std::size_t> bytes_of_;  // by caller
  std::size_t bytes_ = 0, found_ = 0, missed_ = 0, forgotten_ = 0;
};

}  // namespace patchmill
