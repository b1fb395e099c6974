#include "proto/json/json_message.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <absl/strings/str_cat.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/type_resolver_util.h>

#include "proto/json/nearest_word.h"

namespace patchmill {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kNull = "null";
constexpr char kTypePrefix[] = "type.googleapis.com";

// A fault that protobuf would not report: a null or a list in a list, with its line. Empty if there is none.
std::string FaultOfLists(std::string_view text) {
  std::vector<char> open;
  int line = 1;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool in_list = !open.empty() && open.back() == '[';
    switch (c) {
      case '\n':
        ++line;
        break;
      case '"':
      case '\'':
        while (++i < text.size() && text[i] != c) {
          if (text[i] == '\\') ++i;
          if (i < text.size() && text[i] == '\n') ++line;
        }
        break;
      case '[':
        if (in_list)
          return absl::StrCat("line ", line, ": a list in a list; numbers stand in one list, packed");
        open.push_back(c);
        break;
      case '{':
        open.push_back(c);
        break;
      case ']':
      case '}':
        if (!open.empty()) open.pop_back();
        break;
      case 'n':
        if (in_list && text.substr(i, kNull.size()) == kNull)
          return absl::StrCat("line ", line, ": null in a list");
        break;
      default:
        break;
    }
  }
  return "";
}

// The first character of a text that is no object of JSON, for the complaint of protobuf shows a piece of the
// text that says nothing then. Empty for an object, and for what cannot be printed.
std::string BeginOfOtherText(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == text.npos || text[begin] == '{' || text[begin] <= ' ' || text[begin] > '~') return "";
  return std::string(1, text[begin]);
}

google::protobuf::util::TypeResolver* GeneratedTypes() {
  static google::protobuf::util::TypeResolver* const types =
      google::protobuf::util::NewTypeResolverForDescriptorPool(
          kTypePrefix, google::protobuf::DescriptorPool::generated_pool());
  return types;
}

// A text in pieces, which ends early when it is stopped.
class StoppedInput final : public google::protobuf::io::ZeroCopyInputStream {
 public:
  StoppedInput(std::string_view text, const std::function<bool()>& stopped)
      : pieces_(text.data(), static_cast<int>(text.size()), kJsonPieceBytes), ask_(stopped) {}

  bool Next(const void** data, int* size) override {
    stopped_ = stopped_ || (ask_ && ask_());
    return !stopped_ && pieces_.Next(data, size);
  }
  void BackUp(int count) override { pieces_.BackUp(count); }
  bool Skip(int count) override { return pieces_.Skip(count); }
  std::int64_t ByteCount() const override { return pieces_.ByteCount(); }
  bool stopped() const { return stopped_; }

 private:
  google::protobuf::io::ArrayInputStream pieces_;
  const std::function<bool()>& ask_;
  bool stopped_ = false;
};

// The message in a field of this message, by the beginning of a path: "patches[0].bezier". Empty: the
// message itself.
const google::protobuf::Descriptor* MessageAt(const google::protobuf::Descriptor* message,
                                              std::string_view path) {
  while (message != nullptr && !path.empty()) {
    const std::size_t dot = std::min(path.find('.'), path.size());
    const std::string name(path.substr(0, std::min(path.find('['), dot)));
    const google::protobuf::FieldDescriptor* field = message->FindFieldByName(name);
    if (field == nullptr) field = message->FindFieldByCamelcaseName(name);
    message = field == nullptr ? nullptr : field->message_type();
    path.remove_prefix(std::min(dot + 1, path.size()));
  }
  return message;
}

// " Did you mean degree_u?" for protobuf's complaint "(patches[0].bezier) degre_u: Cannot find field.", or
// the list of all fields if none is near. Empty for any other complaint.
std::string NearField(const google::protobuf::Descriptor* message, std::string_view complaint) {
  constexpr std::string_view kEnd = ": Cannot find field.";
  if (complaint.size() < kEnd.size() || complaint.substr(complaint.size() - kEnd.size()) != kEnd) return "";
  std::string_view name = complaint.substr(0, complaint.size() - kEnd.size());
  if (!name.empty() && name.front() == '(') {
    const std::size_t close = name.find(") ");
    if (close == name.npos) return "";
    message = MessageAt(message, name.substr(1, close - 1));
    name.remove_prefix(close + 2);
  }
  if (message == nullptr) return "";
  std::vector<std::string> fields;
  for (int k = 0; k < message->field_count(); ++k) fields.emplace_back(message->field(k)->name());
  const std::string near = NearestWord(name, fields);
  if (!near.empty()) return absl::StrCat(" Did you mean ", near, "?");
  std::string list;
  for (const std::string& field : fields) absl::StrAppend(&list, list.empty() ? " There are " : ", ", field);
  return list + ".";
}

}  // namespace

absl::Status ReadJsonMessage(std::string_view text, google::protobuf::Message& message,
                             const WireCheck& check, const std::function<bool()>& stopped) {
  if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) text.remove_prefix(kByteOrderMark.size());
  if (const std::string begin = BeginOfOtherText(text); !begin.empty())
    return absl::InvalidArgumentError(absl::StrCat("begins with '", begin, "'; must begin with {"));
  if (std::string fault = FaultOfLists(text); !fault.empty()) return absl::InvalidArgumentError(fault);
  std::string wire;
  StoppedInput in(text, stopped);
  google::protobuf::io::StringOutputStream out(&wire);
  const auto status = google::protobuf::util::JsonToBinaryStream(
      GeneratedTypes(), absl::StrCat(kTypePrefix, "/", message.GetDescriptor()->full_name()), &in, &out);
  if (in.stopped()) return absl::CancelledError("reading was stopped");
  if (!status.ok()) {
    const std::string complaint(status.message());
    return absl::InvalidArgumentError(complaint + NearField(message.GetDescriptor(), complaint));
  }
  if (check) {
    if (absl::Status checked = check(wire); !checked.ok()) return checked;
  }
  if (message.ParseFromString(wire)) return absl::OkStatus();
  return absl::InvalidArgumentError("not valid UTF-8, or nested too deep");
}

}  // namespace patchmill
