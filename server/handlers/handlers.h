// One free function per RPC: it converts the request, calls the domain and converts the result. Streams go
// into a sink, so that tests can capture them.
#pragma once

#include <functional>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

#include "patchmill/v1/analysis_service.pb.h"
#include "patchmill/v1/model_service.pb.h"
#include "patchmill/v1/toolpath_service.pb.h"
#include "server/call.h"

namespace patchmill {

absl::Status HandleCheckModel(const Call& call, const v1::CheckModelRequest& request,
                              v1::CheckModelResponse* response);

absl::Status HandleConvertModel(const Call& call, const v1::ConvertModelRequest& request,
                                v1::ConvertModelResponse* response);

absl::Status HandleBuildModel(const Call& call, const v1::BuildModelRequest& request,
                              v1::BuildModelResponse* response);

absl::Status HandleEditModel(const Call& call, const v1::EditModelRequest& request,
                             v1::EditModelResponse* response);

absl::Status HandleFairCurve(const Call& call, const v1::FairCurveRequest& request,
                             v1::FairCurveResponse* response);

absl::Status HandleFairNet(const Call& call, const v1::FairNetRequest& request,
                           v1::FairNetResponse* response);

// Gives the next message of a request of several. False: there is none any more.
template <class Request>
using NextMessage = std::function<absl::StatusOr<bool>(Request&)>;

absl::Status HandleUploadModel(const Call& call, const NextMessage<v1::UploadModelRequest>& next,
                               v1::UploadModelResponse* response);

absl::Status HandleForgetModel(const Call& call, const v1::ForgetModelRequest& request,
                               v1::ForgetModelResponse* response);

absl::Status HandleSplitRegions(const Call& call, const v1::SplitRegionsRequest& request,
                                v1::SplitRegionsResponse* response);

absl::Status HandleTraceLines(const Call& call, const v1::TraceLinesRequest& request,
                              v1::TraceLinesResponse* response);

absl::Status HandleEvaluateSurface(const Call& call, const v1::EvaluateSurfaceRequest& request,
                                   v1::EvaluateSurfaceResponse* response);

absl::Status HandlePreview(const Call& call, const v1::PreviewRequest& request,
                           v1::PreviewResponse* response);

absl::Status HandleTabulateReach(const Call& call, const v1::TabulateReachRequest& request,
                                 v1::TabulateReachResponse* response);

absl::Status HandleGenerateProgram(const Call& call, const v1::GenerateProgramRequest& request,
                                   const Sink<v1::GenerateProgramResponse>& sink);

absl::Status HandleListPosts(const Call& call, const v1::ListPostsRequest& request,
                             v1::ListPostsResponse* response);

absl::Status HandleVerifyProgram(const Call& call, const v1::VerifyProgramRequest& request,
                                 const Sink<v1::VerifyProgramResponse>& sink);

}  // namespace patchmill
