#include "tests/support/golden/canonical.h"

#include <algorithm>
#include <cctype>
#include <functional>
#include <vector>

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

namespace patchmill::testing {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

// Without comments and block number, one blank between words; empty when nothing is left.
std::string Block(std::string_view line) {
  std::string block;
  bool comment = false, blank = false;
  for (const char c : line) {
    if (c == ';' && !comment) break;
    if (c == '(') comment = true;
    if (comment || std::isspace(static_cast<unsigned char>(c)) != 0) {
      blank = true;
    } else {
      if (blank && !block.empty()) block += ' ';
      blank = false;
      block += c;
    }
    if (c == ')') comment = false;
  }
  if (block.empty() || (block[0] != 'N' && block[0] != 'n')) return block;
  const std::size_t number_end = std::min(block.find_first_not_of("0123456789", 1), block.size());
  return block.substr(std::min(block.find_first_not_of(' ', number_end), block.size()));
}

// Calls with_block(block) for each line of the program, in order.
void ForEachLine(std::string_view program, const std::function<void(const std::string&)>& with_block) {
  while (!program.empty()) {
    const std::size_t end = program.find('\n');
    with_block(Block(program.substr(0, end)));
    program.remove_prefix(end == std::string_view::npos ? program.size() : end + 1);
  }
}

// Element k: how many blocks the first k lines have.
std::vector<int> BlockNumbers(std::string_view program) {
  std::vector<int> numbers = {0};
  ForEachLine(program, [&](const std::string& block) { numbers.push_back(numbers.back() + !block.empty()); });
  return numbers;
}

// Calls visit with the message and all messages inside it.
void ForEachMessage(Message& message, const std::function<void(Message&)>& visit) {
  visit(message);
  const auto* reflection = message.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection->ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) continue;
    if (!field->is_repeated()) {
      ForEachMessage(*reflection->MutableMessage(&message, field), visit);
      continue;
    }
    for (int i = 0; i < reflection->FieldSize(message, field); ++i) {
      ForEachMessage(*reflection->MutableRepeatedMessage(&message, field, i), visit);
    }
  }
}

}  // namespace

std::string MotionBlocks(std::string_view program) {
  std::string blocks;
  ForEachLine(program, [&](const std::string& block) {
    if (!block.empty()) blocks += block + '\n';
  });
  return blocks;
}

v1::Report CanonicalReport(v1::Report report, std::string_view program) {
  report.clear_stages();
  report.clear_time_basis();
  report.clear_program_size_bytes();
  report.clear_program_sha256();
  const std::vector<int> numbers = BlockNumbers(program);
  const auto number = [&](int line) {
    return line > 0 && line < static_cast<int>(numbers.size()) ? numbers[static_cast<std::size_t>(line)]
                                                               : line;
  };
  ForEachMessage(report, [&](Message& message) {
    if (auto* finding = dynamic_cast<v1::Diagnostic*>(&message)) finding->clear_message();
    if (auto* where = dynamic_cast<v1::Where*>(&message); where != nullptr && where->has_line()) {
      where->set_line(number(where->line()));
    }
    if (auto* place = dynamic_cast<v1::Place*>(&message)) place->set_line(number(place->line()));
  });
  return report;
}

std::string CanonicalBytes(const Message& message) {
  std::string bytes;
  {
    google::protobuf::io::StringOutputStream stream(&bytes);
    google::protobuf::io::CodedOutputStream coded(&stream);  // writes the last bytes when it is destroyed
    coded.SetSerializationDeterministic(true);
    message.SerializeToCodedStream(&coded);
  }
  return bytes;
}

}  // namespace patchmill::testing
