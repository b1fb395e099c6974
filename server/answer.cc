#include "server/answer.h"

#include <algorithm>
#include <utility>

#include "server/limits.h"

namespace patchmill {

void Answer::Drop() {
  if (keeps_) return;
  std::size_t least = dropped_ + messages_.size();
  for (const Reader* reader : readers_) least = std::min(least, reader->next_);
  while (dropped_ < least) DropFirst();
}

void Answer::DropFirst() {
  const Item& first = messages_.front();
  if (first.counted) ledger_.Release(static_cast<std::int64_t>(first.bytes.Length()));
  messages_.pop_front();
  ++dropped_;
}

Answer::~Answer() {
  while (!messages_.empty()) DropFirst();
}

std::size_t Answer::Behind() const {
  std::size_t bytes = 0;
  for (const Item& message : messages_) bytes += message.bytes.Length();
  return bytes;
}

bool Answer::Write(grpc::ByteBuffer message) {
  std::unique_lock<std::mutex> lock(mutex_);
  const std::size_t size = message.Length();
  bytes_ += size;
  if (bytes_ > kept_bytes_) keeps_ = false;
  const bool counted = ledger_.Take(static_cast<std::int64_t>(size));
  if (!counted) keeps_ = false;
  messages_.push_back({std::move(message), counted});
  Drop();
  changed_.notify_all();
  changed_.wait(
      lock, [&] { return stopped_ || keeps_ || readers_.empty() || Behind() <= limits::kAnswerAheadBytes; });
  return !stopped_ && (keeps_ || !readers_.empty());
}

void Answer::SetProgress(grpc::ByteBuffer progress) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    progress_ = std::move(progress);
    ++progress_number_;
  }
  changed_.notify_all();
}

void Answer::EndProgress() {
  const std::lock_guard<std::mutex> lock(mutex_);
  progress_ended_ = true;
}

void Answer::End(absl::Status status) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!end_) end_ = std::move(status);
  }
  changed_.notify_all();
}

std::unique_ptr<Answer::Reader> Answer::Read() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!keeps_ || stopped_) return nullptr;
  auto reader = std::make_unique<Reader>(*this);
  readers_.push_back(reader.get());
  alone_since_.reset();
  return reader;
}

void Answer::Stop(absl::Status reason) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
    if (!end_) end_ = std::move(reason);
  }
  changed_.notify_all();
}

bool Answer::stopped() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return stopped_;
}

std::optional<std::chrono::steady_clock::time_point> Answer::alone_since() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return alone_since_;
}

std::optional<Messages> Answer::whole() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!keeps_ || !end_ || !end_->ok()) return std::nullopt;
  Messages whole;
  for (const Item& item : messages_) whole.push_back(item.bytes);
  return whole;
}

Answer::Reader::~Reader() {
  {
    const std::lock_guard<std::mutex> lock(answer_.mutex_);
    std::erase(answer_.readers_, this);
    if (answer_.readers_.empty()) answer_.alone_since_ = std::chrono::steady_clock::now();
    answer_.Drop();
  }
  answer_.changed_.notify_all();
}

Answer::Reader::Event Answer::Reader::Next(bool progress, std::chrono::milliseconds wait) {
  std::unique_lock<std::mutex> lock(answer_.mutex_);
  const auto has_message = [&] { return next_ < answer_.dropped_ + answer_.messages_.size(); };
  const auto has_progress = [&] {
    return progress && !answer_.progress_ended_ && answer_.progress_number_ > seen_progress_;
  };
  answer_.changed_.wait_for(
      lock, wait, [&] { return answer_.stopped_ || answer_.end_ || has_message() || has_progress(); });
  if (answer_.stopped_) return *answer_.end_;
  if (has_message()) {
    Message message{answer_.messages_[next_ - answer_.dropped_].bytes};
    ++next_;
    answer_.Drop();
    lock.unlock();
    answer_.changed_.notify_all();
    return message;
  }
  if (answer_.end_) return *answer_.end_;
  if (has_progress()) {
    seen_progress_ = answer_.progress_number_;
    return Progress{answer_.progress_};
  }
  return Nothing{};
}

}  // namespace patchmill
