#include "server/disk_cache.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/digest.h"
#include "server/limits.h"
#include "server/operate/log.h"

namespace patchmill {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "patchmill answer 1\n";
constexpr std::string_view kEnding = ".answer", kTemporary = ".part";
constexpr std::size_t kDigestBytes = 32;

std::string BytesOf(const grpc::ByteBuffer& buffer) {
  std::vector<grpc::Slice> slices;
  std::string bytes;
  if (!buffer.Dump(&slices).ok()) return bytes;
  for (const grpc::Slice& slice : slices)
    bytes.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
  return bytes;
}

// The messages, each after its length in eight bytes.
std::string Pack(const Messages& messages) {
  std::string packed;
  for (const grpc::ByteBuffer& message : messages) {
    const std::string bytes = BytesOf(message);
    std::uint64_t size = bytes.size();
    for (int k = 0; k < 8; ++k, size >>= 8) packed += static_cast<char>(size & 0xFF);
    packed += bytes;
  }
  return packed;
}

std::optional<Messages> Unpack(std::string_view packed) {
  Messages messages;
  while (!packed.empty()) {
    if (packed.size() < 8) return std::nullopt;
    std::uint64_t size = 0;
    for (int k = 7; k >= 0; --k)
      size = size << 8 | static_cast<unsigned char>(packed[static_cast<std::size_t>(k)]);
    packed.remove_prefix(8);
    if (size > packed.size()) return std::nullopt;
    const grpc::Slice slice(packed.data(), size);
    messages.emplace_back(&slice, 1);
    packed.remove_prefix(size);
  }
  return messages;
}

// A descriptor that is closed at the end.
class File {
 public:
  File(const std::string& path, int flags)
      : descriptor_(open(path.c_str(), flags | O_CLOEXEC | O_NOFOLLOW, 0600)) {}
  ~File() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  bool ok() const { return descriptor_ >= 0; }
  bool Write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t n = write(descriptor_, bytes.data(), bytes.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return fsync(descriptor_) == 0;
  }
  // The whole file, if it has at most `most` bytes.
  std::optional<std::string> Read(std::size_t most) const {
    struct stat about {};
    if (fstat(descriptor_, &about) != 0 || !S_ISREG(about.st_mode)) return std::nullopt;
    if (about.st_size < 0 || static_cast<std::size_t>(about.st_size) > most) return std::nullopt;
    std::string bytes(static_cast<std::size_t>(about.st_size), '\0');
    for (std::size_t at = 0; at < bytes.size();) {
      const ssize_t n = read(descriptor_, bytes.data() + at, bytes.size() - at);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return std::nullopt;
      at += static_cast<std::size_t>(n);
    }
    return bytes;
  }

 private:
  const int descriptor_;
};

// First part of the names of a caller's answers.
std::string PrefixOf(const std::string& caller) {
  Canonical digest;
  digest.Add("patchmill files 2").Add(caller);
  return Hex(digest.Digest()).substr(0, 32) + "-";
}

// That of its answers from one model.
std::string PrefixOf(const std::string& caller, const std::string& from) {
  Canonical digest;
  digest.Add("patchmill files of a model 2").Add(caller).Add(from);
  return PrefixOf(caller) + Hex(digest.Digest()).substr(0, 32) + "-";
}

}  // namespace

absl::StatusOr<std::unique_ptr<DiskCache>> DiskCache::Open(const DiskCacheParams& params) {
  std::error_code error;
  const bool made = fs::create_directories(params.folder, error);
  if (made) fs::permissions(params.folder, fs::perms::owner_all, error);
  const std::string probe = fmt::format("{}/.{}{}", params.folder, getpid(), kTemporary);
  const bool writable = File(probe, O_WRONLY | O_CREAT | O_TRUNC).ok();
  const int why = errno;
  unlink(probe.c_str());
  if (!writable) {
    return absl::InvalidArgumentError(
        fmt::format("--cache-dir {}: cannot be written: {}", params.folder, std::strerror(why)));
  }
  std::unique_ptr<DiskCache> cache(new DiskCache(params));
  cache->Prune("", params.limit_bytes);
  return cache;
}

std::string DiskCache::PathOf(const StoreKey& key, const std::string& from) const {
  return fmt::format("{}/{}{}{}", params_.folder, PrefixOf(key.caller, from), Hex(key.digest), kEnding);
}

void DiskCache::Put(const StoreKey& key, const std::string& from, const Messages& messages,
                    std::optional<std::int64_t> share) {
  static std::atomic<std::uint64_t> number{0};
  const std::string packed = Pack(messages), path = PathOf(key, from);
  const std::int64_t most = std::min(params_.limit_bytes, share.value_or(params_.limit_bytes));
  if (static_cast<std::int64_t>(packed.size()) > most / 4) return;
  const std::string part =
      fmt::format("{}/.{}.{}{}", params_.folder, getpid(), number.fetch_add(1), kTemporary);
  bool written = false;
  {
    const File file(part, O_WRONLY | O_CREAT | O_EXCL);
    written = file.ok() && file.Write(std::string(kMagic) + Sha256(packed) + packed);
  }
  if (!written || rename(part.c_str(), path.c_str()) != 0) {
    Log(LogLevel::kWarning, fmt::format("cache: an answer is not kept on disk: {}", std::strerror(errno)));
    unlink(part.c_str());
    return;
  }
  if (share) Prune(PrefixOf(key.caller), *share);
  Prune("", params_.limit_bytes);
}

std::optional<Messages> DiskCache::Find(const StoreKey& key, const std::string& from) {
  const std::string path = PathOf(key, from);
  std::error_code error;
  const auto written = fs::last_write_time(path, error);
  if (error) return std::nullopt;
  const auto age = fs::file_time_type::clock::now() - written;
  std::optional<Messages> messages;
  if (age < params_.lifetime && age > -params_.lifetime) {  // a clock may jump either way
    const File file(path, O_RDONLY);
    const auto bytes = file.ok() ? file.Read(2 * limits::kMaxKeptAnswerBytes) : std::nullopt;
    if (bytes && bytes->size() >= kMagic.size() + kDigestBytes && bytes->starts_with(kMagic)) {
      const std::string_view packed = std::string_view(*bytes).substr(kMagic.size() + kDigestBytes);
      if (Sha256(packed) == bytes->substr(kMagic.size(), kDigestBytes)) messages = Unpack(packed);
    }
    if (!messages) Log(LogLevel::kWarning, fmt::format("cache: {} is damaged and is removed", path));
  }
  if (!messages) unlink(path.c_str());
  return messages;
}

void DiskCache::ForgetModel(const std::string& caller, const std::string& from) {
  const std::string prefix = PrefixOf(caller, from);
  std::error_code error;
  for (fs::directory_iterator at(params_.folder, error), end; !error && at != end; at.increment(error)) {
    if (at->path().filename().string().starts_with(prefix)) unlink(at->path().c_str());
  }
}

void DiskCache::Prune(const std::string& prefix, std::int64_t limit_bytes) {
  struct Kept {
    fs::path path;
    fs::file_time_type written;
    std::int64_t bytes = 0;
  };
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto now = fs::file_time_type::clock::now();
  std::vector<Kept> kept;
  std::int64_t bytes = 0;
  std::error_code error;
  for (fs::directory_iterator at(params_.folder, error), end; !error && at != end; at.increment(error)) {
    const std::string ending = at->path().extension().string();
    if (ending != kEnding && ending != kTemporary) continue;  // no file of the cache
    std::error_code gone;
    const auto written = fs::last_write_time(at->path(), gone);
    const auto size = static_cast<std::int64_t>(fs::file_size(at->path(), gone));
    if (gone) continue;
    // A file that another server is writing is younger than an hour.
    const auto lifetime = ending == kTemporary ? std::chrono::seconds(3600) : params_.lifetime;
    if (now - written > lifetime) {
      unlink(at->path().c_str());
    } else if (ending == kEnding && at->path().filename().string().starts_with(prefix)) {
      kept.push_back({at->path(), written, size});
      bytes += size;
    }
  }
  std::sort(kept.begin(), kept.end(), [](const Kept& a, const Kept& b) { return a.written < b.written; });
  for (auto file = kept.begin(); file != kept.end() && bytes > limit_bytes; ++file) {
    unlink(file->path.c_str());
    bytes -= file->bytes;
  }
}

}  // namespace patchmill
