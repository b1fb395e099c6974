// Previews as a client that drags sees them, from the request to the last byte of the answer.
#include <cmath>

#include <benchmark/benchmark.h>
#include <grpcpp/grpcpp.h>

#include "core/base/digest.h"
#include "patchmill/v1/analysis_service.grpc.pb.h"
#include "patchmill/v1/model_service.grpc.pb.h"
#include "server/server.h"

namespace patchmill::bench {
namespace {

// cells x cells G2-Gregory quads on a wavy sheet, with lines through all vertices.
v1::PatchModel G2Sheet(int cells) {
  const int side = cells + 1;
  v1::PatchModel model;
  model.set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  v1::CurveNetwork& network = *model.mutable_network();
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      auto& vertex = *network.add_vertices();
      for (const double x : {10.0 * i, 10.0 * j, 8 * std::sin(0.5 * i) * std::cos(0.4 * j)})
        vertex.add_position(x);
      if (i + 1 == side || j + 1 == side) continue;
      auto& face = *network.add_faces();
      for (const int v : {i * side + j, (i + 1) * side + j, (i + 1) * side + j + 1, i * side + j + 1}) {
        face.add_vertices(v);
      }
      face.set_scheme(v1::PATCH_SCHEME_G2_GREGORY);
    }
  }
  for (int k = 0; k < side; ++k) {
    auto &row = *network.add_lines(), &column = *network.add_lines();
    for (int j = 0; j < side; ++j) row.add_vertices(k * side + j), column.add_vertices(j * side + k);
  }
  return model;
}

// The model is uploaded. `lines`: with eight highlight lines a turn. `first`: the server keeps nothing and
// answers with all faces.
void Preview(benchmark::State& state, int cells, bool lines, bool first) {
  ServerOptions options;
  options.log_requests = false;
  const auto server = StartEmbeddedServer(options);
  const auto model = v1::ModelService::NewStub(server->InProcessChannel());
  const auto analysis = v1::AnalysisService::NewStub(server->InProcessChannel());
  const std::string content = G2Sheet(cells).SerializeAsString();
  v1::PreviewRequest request;
  {
    grpc::ClientContext context;
    v1::UploadModelResponse uploaded;
    const auto writer = model->UploadModel(&context, &uploaded);
    v1::UploadModelRequest message;
    message.mutable_start()->set_size_bytes(static_cast<std::int64_t>(content.size()));
    message.mutable_start()->set_content_sha256(Sha256(content));
    message.mutable_start()->set_format("pb");
    writer->Write(message);
    message.set_chunk(content);
    writer->Write(message);
    writer->WritesDone();
    if (const grpc::Status status = writer->Finish(); !status.ok()) {
      return state.SkipWithError(status.error_message().c_str());
    }
    request.mutable_source()->set_model_sha256(uploaded.model_sha256());
  }
  if (first) request.set_all_faces(true);
  if (lines) {
    auto& family = *request.add_families();
    family.set_kind(v1::LINE_KIND_HIGHLIGHT);
    family.set_count(8);
  }
  const int middle = cells / 2, face = middle * cells + middle, vertex = middle * (cells + 1) + middle;
  auto& goal = *request.add_edits()->mutable_reach_goals()->add_points();
  goal.set_face(face), goal.set_u(0.4), goal.set_v(0.6);
  auto& bend = *request.add_edits()->mutable_bend_section();
  bend.set_face(face), bend.set_start(vertex), bend.set_end(vertex + 1);
  std::size_t bytes = 0;
  int step = 0, faces = 0;
  for (auto _ : state) {
    // As a hand drags: another distance each time.
    request.mutable_edits(0)->mutable_reach_goals()->mutable_points(0)->set_distance(0.5 +
                                                                                     0.01 * (step % 50));
    request.mutable_edits(1)->mutable_bend_section()->set_curvature(0.01 + 0.0001 * (step++ % 50));
    grpc::ClientContext context;
    v1::PreviewResponse response;
    const grpc::Status status = analysis->Preview(&context, request, &response);
    if (!status.ok()) return state.SkipWithError(status.error_message().c_str());
    if (response.changed_faces().empty()) return state.SkipWithError("no face changed");
    bytes = response.ByteSizeLong();
    faces = response.changed_faces_size();
  }
  state.counters["changed_faces"] = faces;
  state.counters["answer_kB"] = 1e-3 * static_cast<double>(bytes);
}
BENCHMARK_CAPTURE(Preview, faces_36, 6, false, false)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(Preview, faces_36_lines, 6, true, false)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(Preview, faces_900, 30, false, false)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(Preview, faces_900_lines, 30, true, false)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(Preview, faces_900_all, 30, false, true)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace patchmill::bench
