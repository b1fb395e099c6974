#include "server/model_source.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

#include "core/base/digest.h"
#include "core/base/error_details.h"
#include "core/base/status.h"
#include "core/io/model_text.h"
#include "core/network/control_points.h"
#include "proto/json/json_message.h"
#include "server/convert/fields.h"
#include "server/convert/model.h"
#include "server/digest.h"
#include "server/importer.h"
#include "server/limits.h"
#include "server/operate/caller_errors.h"
#include "server/operate/process_counts.h"
#include "server/unknown_fields.h"
#include "server/wire_count.h"
#include "server/wire_limits.h"

namespace patchmill {
namespace {

constexpr std::string_view kTextFormats[] = {"bpt", "bv", "bez", "patches"};

// Limit on the commas of a JSON text. They bound its values: coordinates, weights, knots and patch names.
constexpr std::size_t kMaxJsonCommas =
    4 * limits::kMaxControlPoints + limits::kMaxKnots + 10 * limits::kMaxPatches;

// Limit on the objects of a JSON text. They cost memory before there is a message that could be counted.
constexpr std::size_t kMaxJsonObjects = 2 * limits::kMaxNetworkReferences;

// A message in a file, and what it holds.
struct FileMessage {
  InFlight::Hold held;
  v1::PatchModel model;
};

// Counts the message in `wire` before it is parsed, and holds the memory that it will take. `copied`: also
// the memory of a copy of `wire`.
absl::StatusOr<InFlight::Hold> HoldModelWire(const std::string& wire, bool copied, InFlight* in_flight) {
  google::protobuf::io::ArrayInputStream bytes(wire.data(), static_cast<int>(wire.size()));
  PM_ASSIGN_OR_RETURN(const WireCount count, CountWire(bytes, wire.size(), *v1::PatchModel::descriptor(),
                                                       ListLimits(limits::kMaxFileModelBytes)));
  if (in_flight == nullptr) return InFlight::Hold();
  return in_flight->Take(count.memory_bytes + (copied ? wire.size() : 0));
}

bool LooksLikeJson(std::string_view content) {
  const std::size_t first = content.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return first != std::string_view::npos && (content[first] == '{' || content[first] == '[');
}

absl::StatusOr<FileMessage> ParseJson(const std::string& content, const RunContext& run,
                                      InFlight* in_flight) {
  const auto commas = static_cast<std::size_t>(std::count(content.begin(), content.end(), ','));
  if (commas > kMaxJsonCommas) {
    return LimitError("model.json_value_count", static_cast<double>(kMaxJsonCommas),
                      static_cast<double>(commas));
  }
  const auto objects = static_cast<std::size_t>(std::count(content.begin(), content.end(), '{'));
  if (objects > kMaxJsonObjects) {
    return LimitError("model.json_object_count", static_cast<double>(kMaxJsonObjects),
                      static_cast<double>(objects));
  }
  FileMessage file;
  const auto hold = [&](const std::string& wire) -> absl::Status {
    PM_ASSIGN_OR_RETURN(file.held, HoldModelWire(wire, true, in_flight));
    return absl::OkStatus();
  };
  const absl::Status status =
      ReadJsonMessage(content, file.model, hold, [&run] { return !run.Check().ok(); });
  PM_RETURN_IF_ERROR(run.Check());
  if (absl::IsResourceExhausted(status)) return status;
  if (!status.ok()) {
    return ModelUnreadableError(
        fmt::format("model file: not a PatchModel in JSON: {}", std::string(status.message())));
  }
  return file;
}

absl::StatusOr<FileMessage> ParseBinary(const std::string& content, std::string_view format,
                                        InFlight* in_flight) {
  absl::StatusOr<InFlight::Hold> held = HoldModelWire(content, false, in_flight);
  if (absl::IsResourceExhausted(held.status())) return held.status();
  FileMessage file;
  if (held.ok()) file.held = *std::move(held);
  const v1::PatchModel& model = file.model;
  const bool parsed = held.ok() && file.model.ParseFromString(content);
  if (parsed && (model.patches_size() > 0 || model.has_network())) {
    if (const std::string unknown = UnknownField(model); !unknown.empty()) {
      return ModelUnreadableError(
          fmt::format("model file: {} is a field this server does not know", unknown));
    }
    return file;
  }
  if (format == "pb") {
    return ModelUnreadableError(parsed ? "model file: a binary PatchModel without patches or network"
                                       : "model file: not a binary PatchModel, or truncated");
  }
  return ModelUnreadableError(fmt::format(
      "model file: the content is neither JSON nor a binary PatchModel; if it is a text format, say "
      "which one by the file's ending (.{}), in a request by ModelFile.format",
      fmt::join(kTextFormats, ", .")));
}

Diagnostic FromProto(const v1::Diagnostic& proto) {
  const Severity severity = proto.severity() == v1::SEVERITY_ERROR     ? Severity::kError
                            : proto.severity() == v1::SEVERITY_WARNING ? Severity::kWarning
                                                                       : Severity::kInfo;
  return {proto.code(), severity, proto.message(), {.face_id = proto.where().face_id()}};
}

// What is wrong with a finding that a model brings along; nothing if it may be repeated.
std::optional<Diagnostic> FaultOfFinding(const v1::Diagnostic& proto, int index) {
  const std::string path = fmt::format("findings[{}]", index);
  const auto fault = [&](std::string_view text) {
    return MakeError("INVALID_FINDING", fmt::format("{}.{}", path, text), {.field = path});
  };
  if (proto.severity() != v1::SEVERITY_INFO && proto.severity() != v1::SEVERITY_WARNING)
    return fault("severity must be SEVERITY_INFO or SEVERITY_WARNING");
  if (proto.code().empty() || proto.code().size() > limits::kMaxIdBytes)
    return fault(
        fmt::format("code has {} bytes; must have 1 to {}", proto.code().size(), limits::kMaxIdBytes));
  if (proto.message().size() > limits::kMaxFindingBytes) {
    return fault(fmt::format("message has {} bytes; must have at most {}", proto.message().size(),
                             limits::kMaxFindingBytes));
  }
  if (proto.where().face_id().size() > limits::kMaxIdBytes)
    return fault(fmt::format("where.face_id has {} bytes; must have at most {}",
                             proto.where().face_id().size(), limits::kMaxIdBytes));
  return std::nullopt;
}

// What follows from the faces of a model that are skipped. It is said of every such model, whatever it brings
// along.
constexpr std::string_view kSkippedFace = "SKIPPED_FACE", kNotAllFaces = "NOT_ALL_FACES";

Diagnostics SkippedFindings(const PatchModel& model) {
  constexpr std::size_t kMostListed = 10;
  std::vector<Box3> boxes(model.faces.size());
  for (const Patch& patch : model.patches) {
    if (!patch.face || !model.faces[patch.face->index()].skipped) continue;
    for (const Vec3& p : ControlPoints(patch.shape)) boxes[patch.face->index()].Add(p);
  }
  Diagnostics findings;
  std::vector<std::string> ids;
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    const ModelFace& face = model.faces[f];
    if (!face.skipped) continue;
    ids.push_back(face.id);
    const Box3& box = boxes[f];
    std::string where = "no box around it is known";
    if (!box.Empty()) {
      where = fmt::format(
          "the tool keeps off the box X {:.3f} to {:.3f}, Y {:.3f} to {:.3f}, Z {:.3f} to {:.3f} of the "
          "model "
          "around it",
          box.min.x(), box.max.x(), box.min.y(), box.max.y(), box.min.z(), box.max.z());
    }
    findings.push_back(
        MakeWarning(kSkippedFace,
                    fmt::format("face {} is skipped: {}, and nothing of it is finished", Title(face), where),
                    {.face_id = face.id}));
  }
  if (ids.empty()) return findings;
  const std::size_t count = ids.size();
  if (count > kMostListed) ids.resize(kMostListed);
  findings.insert(
      findings.begin(),
      MakeWarning(
          kNotAllFaces,
          fmt::format("{} of {} faces skipped: {}{}; the tool keeps off a box around each, "
                      "and nothing of them is finished",
                      count, model.faces.size(), fmt::join(ids, ", "), count > kMostListed ? ", ..." : "")));
  return findings;
}

absl::StatusOr<LoadedModel> LoadMessage(const v1::PatchModel& model, const std::string& at,
                                        const RunContext& run) {
  if (model.findings_size() > limits::kMaxModelFindings) {
    return LimitError("model.finding_count", limits::kMaxModelFindings,
                      static_cast<double>(model.findings_size()));
  }
  absl::StatusOr<CheckedModel> checked = FromProto(model, at, run);
  PM_RETURN_IF_ERROR(checked.status());
  LoadedModel loaded;
  loaded.path = at;
  loaded.model = std::move(checked->model);
  loaded.faults = std::move(checked->faults);
  loaded.remarks = std::move(checked->remarks);
  loaded.network = model.has_network();
  if (loaded.faults.empty()) {
    for (Diagnostic& finding : SkippedFindings(loaded.model)) loaded.remarks.push_back(std::move(finding));
  }
  for (int k = 0; k < model.findings_size(); ++k) {
    if (auto wrong = FaultOfFinding(model.findings(k), k)) {
      loaded.faults.push_back(*std::move(wrong));
    } else if (model.findings(k).code() != kSkippedFace && model.findings(k).code() != kNotAllFaces) {
      loaded.remarks.push_back(FromProto(model.findings(k)));
    }
  }
  return loaded;
}

absl::StatusOr<LoadedModel> LoadText(const v1::ModelFile& file, std::string_view at) {
  LoadedModel loaded;
  absl::StatusOr<PatchModel> model = ReadModelText(file.format(), file.content(), &loaded.remarks);
  if (!model.ok()) {
    if (model.status().code() != absl::StatusCode::kInvalidArgument) return model.status();
    return ModelUnreadableError(fmt::format("model file: {}", std::string(model.status().message())),
                                CodeOf(model.status()));
  }
  loaded.path = At(at, "content");
  loaded.model = *std::move(model);
  if (file.length_unit() == v1::LENGTH_UNIT_UNSPECIFIED) {
    loaded.unitless = true;
  } else if (const std::optional<double> unit = MillimetersPer(file.length_unit())) {
    for (Patch& patch : loaded.model.patches) {
      for (Vec3& p : ControlPoints(patch.shape)) p *= *unit;
      for (Bulge& b : Bulges(patch.shape)) b.by *= *unit;
    }
  } else {
    FieldErrors errors;
    errors.Add(At(at, "length_unit"), fmt::format("= {}; this server does not know that value",
                                                  static_cast<int>(file.length_unit())));
    return errors.ToStatus();
  }
  loaded.faults = ValidateModel(loaded.model);
  return loaded;
}

// What was read, in one sentence.
Diagnostic ImportRemark(const v1::ImportReport& report, std::string_view format) {
  std::vector<std::string> kinds;
  for (const v1::ImportedKind& kind : report.kinds()) {
    kinds.push_back(fmt::format("{} {}", kind.face_count(), kind.kind()));
  }
  std::string file = format == "step" ? "STEP" : "IGES";
  if (!report.schema().empty()) file += fmt::format(" ({})", Utf8(report.schema()));
  return MakeInfo(
      "CAD_FILE",
      fmt::format(
          "{} in {}: {} bodies, {} of them solid, {} faces ({}), {:.6g} mm2; borders of faces lie within "
          "{:.2g} mm of the file's edges, edges within {:.2g} mm of their surfaces, surfaces within "
          "{:.2g} mm of the file's",
          file, report.length_unit().empty() ? "unknown unit" : Utf8(report.length_unit()),
          report.body_count(), report.solid_count(), report.face_count(), fmt::join(kinds, ", "),
          report.area_mm2(), report.border_error_mm(), report.largest_gap_mm(), report.surface_error_mm()));
}

// How a CAD file is read, as the request says.
ImportParams ReadImportParams(const v1::ModelFile& file, std::string_view format, std::string_view at,
                              FieldErrors& errors) {
  ImportParams params{.format = format};
  const v1::ImportOptions& options = file.import_options();
  if (options.has_border_tolerance_mm()) {
    params.border_tolerance = options.border_tolerance_mm();
    Require(errors, At(at, "import_options.border_tolerance_mm"), options.border_tolerance_mm(),
            options.border_tolerance_mm() >= limits::kMinBorderToleranceMm &&
                options.border_tolerance_mm() <= limits::kMaxBorderToleranceMm,
            fmt::format("in [{:g}, {:g}]", limits::kMinBorderToleranceMm, limits::kMaxBorderToleranceMm));
  }
  const int count = options.skip_faces_size();
  if (count > limits::kMaxSkippedFaces) {
    errors.Add(At(at, "import_options.skip_faces"),
               fmt::format("has {} elements; must have at most {}", count, limits::kMaxSkippedFaces));
  }
  for (int k = 0; k < count; ++k) {
    RequireBytes(errors, fmt::format("{}[{}]", At(at, "import_options.skip_faces"), k), options.skip_faces(k),
                 limits::kMaxIdBytes);
    if (options.skip_faces(k).find('\0') != std::string::npos)
      errors.Add(fmt::format("{}[{}]", At(at, "import_options.skip_faces"), k), "has a byte 0");
    params.skipped.push_back(options.skip_faces(k));
  }
  return params;
}

// OK if nothing is asked of a file that only CAD files have.
absl::Status RefuseImportOptions(const v1::ModelFile& file, std::string_view at) {
  FieldErrors errors;
  if (file.import_options().has_border_tolerance_mm()) {
    errors.Add(At(at, "import_options.border_tolerance_mm"),
               "is set; only CAD files (step, iges) are read with it");
  }
  if (file.import_options().skip_faces_size() > 0) {
    errors.Add(
        At(at, "import_options.skip_faces"),
        "is set; only faces of CAD files (step, iges) are skipped; those of other models can be avoided");
  }
  return errors.ToStatus();
}

// Digest of a CAD file, of how it is read, and of the program that reads it.
std::string ImportDigest(const v1::ModelFile& file, std::string_view format) {
  Canonical digest;
  digest.Add("patchmill import 1").Add(format).Add(Sha256(file.content()));
  digest.Add(file.import_options().SerializeAsString());
  digest.Add(ImporterStamp());
  return digest.Digest();
}

// Loads a STEP or IGES file through the importer. Its answer is checked like any message.
absl::StatusOr<LoadedModel> LoadCad(const v1::ModelFile& file, std::string_view format, const std::string& at,
                                    const RunContext& run, const ModelAccess& access) {
  FieldErrors errors;
  if (file.length_unit() != v1::LENGTH_UNIT_UNSPECIFIED)
    errors.Add(At(at, "length_unit"), "must be unset: a CAD file states its own unit");
  const ImportParams params = ReadImportParams(file, format, at, errors);
  PM_RETURN_IF_ERROR(errors.ToStatus());
  StoreKey key{Stored::kImport, access.caller, {}};
  if (access.store != nullptr) {
    key.digest = ImportDigest(file, format);
    if (const auto known = access.store->Find<LoadedModel>(key)) {
      LoadedModel loaded = *known;
      loaded.path = At(at, "content");
      return loaded;
    }
  }
  const absl::StatusOr<Imported> imported = ImportFile(file.content(), params, run, access.in_flight);
  if (!imported.ok() && !run.Cancelled()) Counts().failed_imports.fetch_add(1);
  if (CodeOf(imported.status()) == "UNKNOWN_FACE") {
    errors.Add(At(at, "import_options.skip_faces"), std::string(imported.status().message()));
    return errors.ToStatus();
  }
  PM_RETURN_IF_ERROR(imported.status());
  const v1::ImportResult& result = imported->result;
  PM_ASSIGN_OR_RETURN(LoadedModel loaded, LoadMessage(result.model(), At(at, "content"), run));
  loaded.remarks.push_back(ImportRemark(result.report(), format));
  for (const v1::Diagnostic& finding : result.report().findings()) {
    Diagnostic remark = FromProto(finding);
    (remark.severity == Severity::kError ? loaded.faults : loaded.remarks).push_back(std::move(remark));
  }
  if (access.store != nullptr && loaded.faults.empty()) {
    access.store->Put<LoadedModel>(key, std::make_shared<const LoadedModel>(loaded), MemoryOf(loaded.model));
  }
  return loaded;
}

bool IsText(const std::string& format) {
  return std::find(std::begin(kTextFormats), std::end(kTextFormats), format) != std::end(kTextFormats);
}

// Loads a .json or .pb file.
absl::StatusOr<FileMessage> ParseMessage(const v1::ModelFile& file, std::string_view at,
                                         const RunContext& run, InFlight* in_flight) {
  if (!(file.format().empty() || file.format() == "json" || file.format() == "pb")) {
    FieldErrors errors;
    errors.Add(At(at, "format"),
               fmt::format("= \"{}\"; must be one of {}, step, iges, json, pb",
                           Utf8(file.format().substr(0, 50)), fmt::join(kTextFormats, ", ")));
    return errors.ToStatus();
  }
  PM_ASSIGN_OR_RETURN(FileMessage message, LooksLikeJson(file.content()) || file.format() == "json"
                                               ? ParseJson(file.content(), run, in_flight)
                                               : ParseBinary(file.content(), file.format(), in_flight));
  if (file.length_unit() != v1::LENGTH_UNIT_UNSPECIFIED &&
      file.length_unit() != message.model.length_unit()) {
    FieldErrors errors;
    errors.Add(At(at, "length_unit"), "differs from the file's own length_unit; leave it unset");
    return errors.ToStatus();
  }
  return message;
}

absl::Status RequireContent(const v1::ModelFile& file) {
  return file.content().empty() ? ModelUnreadableError("model file: empty") : absl::OkStatus();
}

absl::StatusOr<LoadedModel> LoadFile(const v1::ModelFile& file, const std::string& at, const RunContext& run,
                                     const ModelAccess& access) {
  PM_RETURN_IF_ERROR(RequireContent(file));
  const std::string_view cad = CadFormat(file.format());
  if (!cad.empty()) return LoadCad(file, cad, at, run, access);
  PM_RETURN_IF_ERROR(RefuseImportOptions(file, at));
  if (IsText(file.format())) return LoadText(file, at);
  PM_ASSIGN_OR_RETURN(const FileMessage message, ParseMessage(file, at, run, access.in_flight));
  return LoadMessage(message.model, At(at, "content"), run);
}

absl::Status NoSource(std::string_view at) {
  FieldErrors errors;
  errors.Missing(std::string(at));
  return errors.ToStatus();
}

// The model with that digest that the caller has uploaded.
absl::StatusOr<std::shared_ptr<const StoredModel>> FindStored(const std::string& digest,
                                                              const ModelAccess& access) {
  if (access.store != nullptr) {
    if (auto stored = access.store->Find<StoredModel>({Stored::kModel, access.caller, digest})) return stored;
  }
  return ModelNotCachedError();
}

absl::StatusOr<LoadedModel> Load(const v1::ModelSource& source, std::string_view at, const RunContext& run,
                                 const ModelAccess& access) {
  switch (source.source_case()) {
    case v1::ModelSource::kModel:
      return LoadMessage(source.model(), At(at, "model"), run);
    case v1::ModelSource::kFile:
      return LoadFile(source.file(), At(at, "file"), run, access);
    case v1::ModelSource::kModelSha256: {
      PM_ASSIGN_OR_RETURN(const auto stored, FindStored(source.model_sha256(), access));
      LoadedModel loaded = stored->loaded;
      loaded.path = At(at, "model_sha256");
      return loaded;
    }
    case v1::ModelSource::SOURCE_NOT_SET:
      break;
  }
  return NoSource(at);
}

}  // namespace

absl::StatusOr<LoadedModel> LoadModel(const v1::ModelSource& source, std::string_view at,
                                      const RunContext& run, const ModelAccess& access) {
  PM_ASSIGN_OR_RETURN(LoadedModel loaded, Load(source, at, run, access));
  if (!loaded.digest.empty() && source.has_model_sha256()) return loaded;
  PM_RETURN_IF_ERROR(run.Check());
  loaded.digest = ModelDigest(loaded.model);
  return loaded;
}

absl::StatusOr<LoadedNetwork> LoadNetwork(const v1::ModelSource& source, std::string_view at,
                                          const RunContext& run, const ModelAccess& access) {
  LoadedNetwork loaded;
  std::string path;
  switch (source.source_case()) {
    case v1::ModelSource::kModel:
      loaded.message = source.model();
      path = At(at, "model");
      break;
    case v1::ModelSource::kFile: {
      PM_RETURN_IF_ERROR(RequireContent(source.file()));
      path = At(at, "file");
      PM_RETURN_IF_ERROR(RefuseImportOptions(source.file(), path));
      if (IsText(source.file().format())) {
        FieldErrors errors;
        errors.Add(At(path, "format"),
                   fmt::format("= \"{}\"; must be json or pb, with a network", source.file().format()));
        return errors.ToStatus();
      }
      PM_ASSIGN_OR_RETURN(FileMessage file, ParseMessage(source.file(), path, run, access.in_flight));
      loaded.held = std::move(file.held);
      loaded.message = std::move(file.model);
      path = At(path, "content");
      break;
    }
    case v1::ModelSource::kModelSha256: {
      PM_ASSIGN_OR_RETURN(const auto stored, FindStored(source.model_sha256(), access));
      path = At(at, "model_sha256");
      if (stored->network.empty()) {
        FieldErrors errors;
        errors.Add(path, "names a model of patches; must be one with a network");
        return errors.ToStatus();
      }
      if (!loaded.message.ParseFromString(stored->network))
        return absl::InternalError("a stored network is damaged");
      break;
    }
    case v1::ModelSource::SOURCE_NOT_SET:
      return NoSource(at);
  }
  PM_ASSIGN_OR_RETURN(loaded.checked, NetworkFromProto(loaded.message, path));
  return loaded;
}

absl::Status KeepModel(const LoadedModel& loaded, const v1::ModelSource& source, const RunContext& run,
                       const ModelAccess& access) {
  if (access.store == nullptr) return absl::OkStatus();
  Canonical findings;
  findings.Add(std::int64_t{loaded.unitless});
  for (const Diagnostic& remark : loaded.remarks)
    findings.Add(remark.code).Add(static_cast<std::int64_t>(remark.severity)).Add(remark.message);
  StoredModel stored{loaded, {}, findings.Digest()};
  if (loaded.network) {
    PM_ASSIGN_OR_RETURN(const LoadedNetwork network, LoadNetwork(source, "source", run, access));
    stored.network = network.message.SerializeAsString();
  }
  const std::size_t bytes = MemoryOf(loaded.model) + stored.network.size();
  if (access.store->Put<StoredModel>({Stored::kModel, access.caller, loaded.digest},
                                     std::make_shared<const StoredModel>(std::move(stored)), bytes))
    return absl::OkStatus();
  const std::size_t share = access.store->LimitOf(access.caller);
  if (share < access.store->limit_bytes() && bytes <= access.store->limit_bytes())
    return QuotaError("caller_store_bytes", static_cast<double>(share), static_cast<double>(bytes),
                      std::nullopt);
  return LimitError("stored_model_bytes", static_cast<double>(access.store->limit_bytes()),
                    static_cast<double>(bytes), "patchmilld --store-mib sets the limit");
}

std::string FindingsOfStored(Store& store, const StoreKey& key) {
  if (key.digest.empty()) return {};
  const auto stored = store.Find<StoredModel>(key);
  return stored == nullptr ? std::string() : stored->findings_digest;
}

std::size_t MemoryOf(const PatchModel& model) {
  std::size_t bytes = 500 * model.faces.size();
  for (const Patch& patch : model.patches)
    bytes += sizeof(Patch) + patch.id.capacity() + 32 * ControlPoints(patch.shape).size() +
             64 * Bulges(patch.shape).size();
  return bytes;
}

}  // namespace patchmill
