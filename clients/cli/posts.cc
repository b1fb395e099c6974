#include "clients/cli/posts.h"

#include <algorithm>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "clients/cli/call.h"
#include "clients/cli/commands.h"
#include "clients/cli/job_options.h"
#include "patchmill/v1/toolpath_service.grpc.pb.h"

namespace patchmill::cli {
namespace {

struct PostsOptions {
  CommonOptions common;
  std::string name;
};

void PrintList(const v1::ListPostsResponse& response) {
  std::size_t name_width = 4, title_width = 8;
  for (const v1::PostInfo& post : response.posts()) {
    name_width = std::max(name_width, post.name().size());
    title_width = std::max(title_width, post.title().size());
  }
  fmt::print("{:<{}}  {:<{}}  {:<17}  {}\n", "name", name_width, "controls", title_width, "decimals mm, inch",
             "word for the tolerance of the path");
  for (const v1::PostInfo& post : response.posts()) {
    const std::string decimals = fmt::format("{}, {}", post.decimals(), post.decimals_inch());
    fmt::print("{:<{}}  {:<{}}  {:<17}  {}\n", post.name(), name_width, post.title(), title_width, decimals,
               post.path_tolerance().empty() ? "none" : post.path_tolerance());
  }
}

absl::StatusOr<v1::ListPostsResponse> ListPosts(const CommonOptions& options, InterruptWatch& watch) {
  return Call<v1::ToolpathService::Stub, v1::ListPostsRequest, v1::ListPostsResponse>(
      options, watch, &v1::ToolpathService::Stub::ListPosts, {});
}

absl::Status Run(const PostsOptions& options, InterruptWatch& watch) {
  absl::StatusOr<v1::ListPostsResponse> response = ListPosts(options.common, watch);
  if (!response.ok()) return response.status();
  if (options.name.empty()) {
    PrintList(*response);
    return absl::OkStatus();
  }
  std::string names;
  for (const v1::PostInfo& post : response->posts()) {
    if (post.name() == options.name) {
      fmt::print("{}", post.post_file());
      return absl::OkStatus();
    }
    names += (names.empty() ? "" : ", ") + post.name();
  }
  return absl::InvalidArgumentError(fmt::format("\"{}\" is no dialect; there are: {}", options.name, names));
}

}  // namespace

absl::StatusOr<std::vector<std::string>> PostNames(const CommonOptions& options, InterruptWatch& watch) {
  absl::StatusOr<v1::ListPostsResponse> response = ListPosts(options, watch);
  if (!response.ok()) return response.status();
  std::vector<std::string> names;
  for (const v1::PostInfo& post : response->posts()) names.push_back(post.name());
  return names;
}

Command AddPosts(CLI::App& app) {
  auto options = std::make_shared<PostsOptions>();
  app.add_option("NAME", options->name, "print the post file of this dialect: a start for one of your own");
  AddCommonOptions(app, options->common);
  return [options](InterruptWatch& watch) { return Run(*options, watch); };
}

}  // namespace patchmill::cli
