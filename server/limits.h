// Every limit of the service, with its unit. All are checked before the cost they bound is paid.
#pragma once

#include <cstddef>

namespace patchmill::limits {

// Messages and connections.
inline constexpr std::size_t kMaxMessageBytes = std::size_t{64} << 20;  // in both directions
inline constexpr std::size_t kMaxSmallMessageBytes = 4096;              // requests to health and reflection
inline constexpr int kMaxInFlightMib = 256;  // default: MiB of requests and answers at once
inline constexpr std::size_t kMaxFileModelBytes = std::size_t{256}
                                                  << 20;                // memory of a message in a model file
inline constexpr std::size_t kMaxUploadBytes = std::size_t{256} << 20;  // of one model file
inline constexpr std::size_t kMaxKeptAnswerBytes = std::size_t{64} << 20;  // of an answer that is kept whole
inline constexpr std::size_t kAnswerAheadBytes = std::size_t{4} << 20;  // that a job is ahead of its readers
inline constexpr int kReceiveSeconds = 300;         // from the start of a call until its request has arrived
inline constexpr int kUploadSeconds = 900;          // from the start of an upload until its last byte
inline constexpr int kMeasureMs = 10;               // requests on their way are measured this often
inline constexpr int kMaxCallsPerConnection = 100;  // at once; further calls wait at the client
inline constexpr int kMaxConnections = 10'000;      // open at once; fewer if there are fewer descriptors
inline constexpr int kSpareDescriptors = 64;        // never taken by connections
inline constexpr int kClientPingSeconds = 5;        // a client may ping as often as this
inline constexpr int kPingSeconds = 60;             // the server pings a silent client as often as this
inline constexpr int kPingAnswerSeconds = 20;       // a client that has not answered a ping by then is gone
inline constexpr int kConnectionHours = 12;         // age at which clients are asked to connect anew
inline constexpr int kHandshakeSeconds = 20;        // from the start of a connection until it speaks HTTP/2
inline constexpr std::size_t kChunkBytes = std::size_t{256} << 10;  // of a piece of a program or artifact
inline constexpr std::size_t kPathChunkPoints = 4096;               // of one PathChunk or PathBlock
inline constexpr std::size_t kMeshBlockVertices = 16'384;           // of a MeshBlock of several pieces
inline constexpr double kMinChordMm = 1e-4, kMaxChordMm = 1e3;      // of triangles
inline constexpr std::size_t kMaxStatusBytes = 4096;  // of grpc-status-details-bin; trailers end at 8 KiB
inline constexpr std::size_t kMaxStatusMessageBytes = 1000;
inline constexpr int kMaxViolations = 20;
inline constexpr std::size_t kMaxPictureBytes = std::size_t{8} << 20;
inline constexpr int kMaxTools = 20;                  // of VerifyProgram
inline constexpr std::size_t kMaxDiagnostics = 2000;  // of one answer; further ones are only counted

// Models.
inline constexpr std::size_t kMaxPatches = 100'000;
// Control points of all patches together; 100,000 bicubic patches have 1.6 million. A patch of many pieces
// (B-spline, Brown, Hosaka) counts as the points of its pieces.
inline constexpr std::size_t kMaxControlPoints = 2'500'000;
inline constexpr std::size_t kMaxKnots = 2'500'000;  // of all patches together
inline constexpr std::size_t kMaxNetworkVertices = 4 * kMaxPatches;
inline constexpr std::size_t kMaxNetworkEdges = 4 * kMaxPatches;
inline constexpr std::size_t kMaxNetworkReferences = 16 * kMaxPatches;  // vertices of faces, faces of normals
// Numbers in all lists of a request together: coordinates, weights and knots.
inline constexpr std::size_t kMaxRequestNumbers = 4 * kMaxControlPoints + kMaxKnots;
inline constexpr std::size_t kMaxIdBytes = 200;
inline constexpr int kMaxSkippedFaces = 1000;          // of one CAD file
inline constexpr int kMaxModelFindings = 5000;         // that a model brings along
inline constexpr std::size_t kMaxFindingBytes = 4000;  // of the message of one
inline constexpr std::size_t kMaxNameBytes = 100;
inline constexpr std::size_t kMaxRequestIdBytes = 128;

// Jobs.
inline constexpr int kMaxThreads = 64;            // of one job
inline constexpr int kMaxJobs = 64;               // of one server at once
inline constexpr int kQuickPlaces = 8;            // calls at once that are no jobs
inline constexpr int kMaxQueue = 1000;            // calls that wait, of each kind
inline constexpr double kMaxJobSeconds = 3600.0;  // default of the server
// Limits of the passes of one plan, counted while they are made, and of the program with its links. A job
// ends when it exceeds them (cam/toolpath/counted_loop.h), or before its passes are made if no finish could
// be shorter (LeastCutLength). Each plan that the choice of an angle makes counts by itself. A point takes
// about 0.6 kB of memory. The verifier reads as many points of a program from elsewhere.
inline constexpr double kMaxCutLengthMm = 5e6;
inline constexpr double kMaxPathPoints = 5e6;
inline constexpr std::size_t kMaxOutlinePoints =
    20'000;  // of all boundary rings of a job, and of all its obstacles
inline constexpr int kMaxObstacles = 1000;
inline constexpr int kMaxRegionOverrides = 1000;
inline constexpr std::size_t kMaxProgramBytes = std::size_t{512} << 20;  // of a program made here

// Curves.
inline constexpr std::size_t kMaxCurvePoints = 100'000;  // of a request; the limit of locks, too
inline constexpr double kMaxPolylinePoints = 1e6;        // of an answer
inline constexpr double kMaxCurveCoordinate = 1e9;       // in the unit of the curve

// Lines and evaluations.
inline constexpr int kMaxLineFamilies = 20;
inline constexpr int kMaxLineLevels = 1000;  // of a family
inline constexpr int kMaxEvaluations = 200'000;

// Times of the service.
inline constexpr int kCancelPollMs = 50;  // a cancel is noticed within this time
inline constexpr int kHeartbeatMs = 250;  // Progress is sent this often
inline constexpr int kAbandonMs = 500;    // from the end of a drain until the server is closed

// Ranges of single fields. Error messages state them.
inline constexpr double kMinDiameterMm = 0.02, kMaxDiameterMm = 1000.0;
inline constexpr double kMinToleranceMm = 1e-4;
inline constexpr double kMaxLeaveMm = 100.0;
inline constexpr double kMaxAllowanceMm = 100.0;
inline constexpr double kMaxStockMarginMm = 10000.0, kMaxDepthMm = 1000.0;
inline constexpr double kMaxApproachGapMm = 100.0;
inline constexpr double kMaxClearanceAboveMm = 1e4;
inline constexpr double kMaxCoordinateMm = 1e5;
inline constexpr double kMaxAvoidMarginMm = 100.0;
inline constexpr double kMaxOutlineOffsetMm = 1000.0;
inline constexpr double kMinSteepDeg = 5.0, kMaxSteepDeg = 85.0;
inline constexpr double kMinRpm = 1.0, kMaxRpm = 1e6;
inline constexpr double kMinFeed = 0.1, kMaxFeed = 1e6;  // mm/min
inline constexpr int kMaxToolNumber = 99'999;
inline constexpr double kMinBorderToleranceMm = 1e-6, kMaxBorderToleranceMm = 0.05;
inline constexpr double kMinScale = 1e-6, kMaxScale = 1e6;
inline constexpr double kMaxJoinToleranceMm = 10.0;
inline constexpr int kMaxContinuitySteps = 10'000;

}  // namespace patchmill::limits
