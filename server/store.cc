#include "server/store.h"

#include <algorithm>
#include <utility>

namespace patchmill {

void Store::Forget(Entries::iterator entry, Entries& forgotten) {
  bytes_ -= entry->bytes;
  const auto of_caller = bytes_of_.find(entry->key.caller);
  of_caller->second -= entry->bytes;
  if (of_caller->second == 0) bytes_of_.erase(of_caller);
  by_key_.erase(entry->key);
  forgotten.splice(forgotten.end(), entries_, entry);
}

void Store::Erase(Entries::iterator entry) {
  Entries forgotten;
  Forget(entry, forgotten);
}

std::optional<std::int64_t> Store::ShareOf(const std::string& caller) const {
  return share_of_ ? share_of_(caller) : std::nullopt;
}

std::size_t Store::LimitOf(const std::string& caller) const {
  const std::optional<std::int64_t> share = share_of_ ? share_of_(caller) : std::nullopt;
  return share ? std::min(limit_, static_cast<std::size_t>(*share)) : limit_;
}

bool Store::PutAny(const StoreKey& key, std::any value, std::size_t bytes, std::string from) {
  constexpr std::size_t kEntryBytes = 500;  // of the entry itself
  bytes += kEntryBytes;
  const std::size_t limit = LimitOf(key.caller);
  Entries forgotten;  // destroyed without the lock
  const std::lock_guard<std::mutex> lock(mutex_);
  if (const auto at = by_key_.find(key); at != by_key_.end()) Forget(at->second, forgotten);
  if (bytes > (key.kind == Stored::kModel ? limit : limit / 4)) return false;
  const auto taken = [&] {
    const auto at = bytes_of_.find(key.caller);
    return at == bytes_of_.end() ? std::size_t{0} : at->second;
  };
  for (auto entry = entries_.end(); limit < limit_ && taken() + bytes > limit;) {
    --entry;
    if (entry->key.caller != key.caller) continue;
    const auto own = entry++;
    Forget(own, forgotten);
    ++forgotten_;
  }
  while (bytes_ + bytes > limit_) {
    Forget(std::prev(entries_.end()), forgotten);
    ++forgotten_;
  }
  entries_.push_front({key, std::move(value), bytes, std::move(from)});
  by_key_.emplace(key, entries_.begin());
  bytes_ += bytes;
  bytes_of_[key.caller] += bytes;
  return true;
}

std::any Store::FindAny(const StoreKey& key) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto at = by_key_.find(key);
  if (at == by_key_.end()) {
    ++missed_;
    return {};
  }
  ++found_;
  entries_.splice(entries_.begin(), entries_, at->second);
  return at->second->value;
}

bool Store::ForgetModel(const std::string& caller, const std::string& digest) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    const auto next = std::next(entry);
    if ((entry->key.kind == Stored::kAnswer || entry->key.kind == Stored::kSurface ||
         entry->key.kind == Stored::kJoined) &&
        entry->key.caller == caller && entry->from == digest)
      Erase(entry);
    entry = next;
  }
  const auto at = by_key_.find({Stored::kModel, caller, digest});
  if (at == by_key_.end()) return false;
  Erase(at->second);
  return true;
}

Store::Figures Store::figures() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return {entries_.size(), bytes_, limit_, found_, missed_, forgotten_};
}

}  // namespace patchmill
