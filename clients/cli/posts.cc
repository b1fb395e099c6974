#include "clients/cli/posts.h"

#include <algorithm>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "clients/cli/call.h"
#include "clients/cli/commands.h"
#include "clients/cli/input_file.h"
#include "clients/cli/job_options.h"
#include "patchmill/v1/toolpath_service.grpc.pb.h"

namespace patchmill::cli {
namespace {

struct PostsOptions {
  CommonOptions common;
  std::string name;
  std::string check;  // a file
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

absl::StatusOr<v1::ListPostsResponse> ListPosts(const CommonOptions& options,
                                                const v1::ListPostsRequest& request, InterruptWatch& watch) {
  return Call<v1::ToolpathService::Stub, v1::ListPostsRequest, v1::ListPostsResponse>(
      options, watch, &v1::ToolpathService::Stub::ListPosts, request);
}

void PrintCheck(const std::string& file, const v1::PostCheck& check) {
  for (const v1::PostFault& fault : check.faults()) {
    fmt::print("{}{}: {}\n", file, fault.line() > 0 ? fmt::format(":{}", fault.line()) : "", fault.message());
  }
  if (check.faults().empty()) fmt::print("{}: no faults; dialect {}\n", file, check.name());
  if (!check.base().empty()) {
    fmt::print("derived from {}: {} line{} of its own, {} of {} missing\n", check.base(),
               check.own_lines_size(), check.own_lines_size() == 1 ? "" : "s", check.missing_lines_size(),
               check.base());
  }
  for (const v1::PostLine& line : check.own_lines()) fmt::print("  + {}: {}\n", line.line(), line.text());
  for (const std::string& line : check.missing_lines()) fmt::print("  - {}\n", line);
  if (check.left_to_control().empty()) return;
  fmt::print("left to the control:\n");
  for (const std::string& sentence : check.left_to_control()) fmt::print("  {}\n", sentence);
}

absl::Status Run(const PostsOptions& options, InterruptWatch& watch) {
  v1::ListPostsRequest request;
  if (!options.check.empty()) {
    absl::StatusOr<std::string> text = ReadWholeFile(options.check);
    if (!text.ok()) return text.status();
    for (char& c : *text) {
      if (static_cast<unsigned char>(c) >= 0x80) c = '\x01';  // the server names the line
    }
    request.set_post_file(*std::move(text));
  }
  absl::StatusOr<v1::ListPostsResponse> response = ListPosts(options.common, request, watch);
  if (!response.ok()) return response.status();
  if (!options.check.empty()) {
    PrintCheck(options.check, response->check());
    const int faults = response->check().faults_size();
    if (faults == 0) return absl::OkStatus();
    return absl::FailedPreconditionError(
        fmt::format("{}: {} fault{}", options.check, faults, faults == 1 ? "" : "s"));
  }
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
  absl::StatusOr<v1::ListPostsResponse> response = ListPosts(options, {}, watch);
  if (!response.ok()) return response.status();
  std::vector<std::string> names;
  for (const v1::PostInfo& post : response->posts()) names.push_back(post.name());
  return names;
}

Command AddPosts(CLI::App& app) {
  auto options = std::make_shared<PostsOptions>();
  CLI::Option* const name = app.add_option(
      "NAME", options->name, "print the post file of this dialect: a start for one of your own");
  app.add_option(
         "--check", options->check,
         "say every fault of a post file with its line, what it derives from, and what it leaves to the "
         "control; exit 1 with faults")
      ->type_name("FILE")
      ->excludes(name);
  AddCommonOptions(app, options->common);
  return [options](InterruptWatch& watch) { return Run(*options, watch); };
}

}  // namespace patchmill::cli
