#include "cam/plan/check_post.h"
#include "cam/post/dialect.h"
#include "core/base/status.h"
#include "server/errors.h"
#include "server/handlers/handlers.h"
#include "server/handlers/prepare.h"

namespace patchmill {
namespace {

void AddCheck(const PostCheck& check, v1::PostCheck& out) {
  for (const PostFault& fault : check.faults) {
    v1::PostFault& added = *out.add_faults();
    added.set_line(fault.line);
    added.set_message(Utf8(fault.message));
  }
  out.set_name(Utf8(check.name));
  out.set_base(check.base);
  for (const PostCheck::OwnLine& line : check.own_lines) {
    v1::PostLine& added = *out.add_own_lines();
    added.set_line(line.line);
    added.set_text(Utf8(line.text));
  }
  for (const std::string& line : check.missing_lines) out.add_missing_lines(line);
  for (const std::string& sentence : check.left_to_control) out.add_left_to_control(Utf8(sentence));
}

}  // namespace

absl::Status HandleListPosts(const Call&, const v1::ListPostsRequest& request,
                             v1::ListPostsResponse* response) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  for (const Dialect& dialect : Dialects()) {
    v1::PostInfo& info = *response->add_posts();
    info.set_name(dialect.name);
    info.set_title(dialect.title);
    info.set_path_tolerance(dialect.path_tolerance);
    info.set_decimals(dialect.decimals[ProgramUnit::kMillimeter]);
    if (HasUnit(dialect, ProgramUnit::kInch)) info.set_decimals_inch(dialect.decimals[ProgramUnit::kInch]);
    info.set_post_file(dialect.text);
  }
  if (request.has_post_file()) AddCheck(CheckPostFile(request.post_file()), *response->mutable_check());
  return absl::OkStatus();
}

}  // namespace patchmill
