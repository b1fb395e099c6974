#include "server/store.h"

#include <utility>

namespace patchmill {

void Store::Erase(Entries::iterator entry) {
  bytes_ -= entry->bytes;
  by_key_.erase(entry->key);
  entries_.erase(entry);
}

bool Store::PutAny(const StoreKey& key, std::any value, std::size_t bytes, std::string from) {
  constexpr std::size_t kEntryBytes = 500;  // of the entry itself
  bytes += kEntryBytes;
  Entries forgotten;  // destroyed without the lock
  const std::lock_guard<std::mutex> lock(mutex_);
  if (const auto at = by_key_.find(key); at != by_key_.end()) {
    bytes_ -= at->second->bytes;
    forgotten.splice(forgotten.end(), entries_, at->second);
    by_key_.erase(at);
  }
  if (bytes > (key.kind == Stored::kModel ? limit_ : limit_ / 4)) return false;
  while (bytes_ + bytes > limit_) {
    const auto last = std::prev(entries_.end());
    bytes_ -= last->bytes;
    by_key_.erase(last->key);
    forgotten.splice(forgotten.end(), entries_, last);
    ++forgotten_;
  }
  entries_.push_front({key, std::move(value), bytes, std::move(from)});
  by_key_.emplace(key, entries_.begin());
  bytes_ += bytes;
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
    if ((entry->key.kind == Stored::kAnswer || entry->key.kind == Stored::kSurface) &&
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
