#include "server/kept_answers.h"

#include <utility>

namespace patchmill {
namespace {

std::size_t SizeOf(const Messages& messages) {
  std::size_t bytes = 0;
  for (const grpc::ByteBuffer& message : messages) bytes += message.Length();
  return bytes;
}

}  // namespace

void KeptAnswers::Put(const StoreKey& key, const std::string& from, Messages messages) {
  if (disk_) disk_->Put(key, from, messages, store_.ShareOf(key.caller));
  const std::size_t bytes = SizeOf(messages);
  store_.Put<Messages>(key, std::make_shared<const Messages>(std::move(messages)), bytes, from);
}

std::shared_ptr<const Messages> KeptAnswers::Find(const StoreKey& key, const std::string& from) {
  if (auto kept = store_.Find<Messages>(key)) return kept;
  if (!disk_) return nullptr;
  auto read = disk_->Find(key, from);
  if (!read) return nullptr;
  const std::size_t bytes = SizeOf(*read);
  auto kept = std::make_shared<const Messages>(*std::move(read));
  store_.Put<Messages>(key, kept, bytes, from);
  return kept;
}

bool KeptAnswers::ForgetModel(const std::string& caller, const std::string& digest) {
  if (disk_) disk_->ForgetModel(caller, digest);
  return store_.ForgetModel(caller, digest);
}

}  // namespace patchmill
