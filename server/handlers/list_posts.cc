#include "cam/post/dialect.h"
#include "core/base/status.h"
#include "server/handlers/handlers.h"
#include "server/handlers/prepare.h"

namespace patchmill {

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
  return absl::OkStatus();
}

}  // namespace patchmill
