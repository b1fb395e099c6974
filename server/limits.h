// Every limit of the service, with its unit. All are checked before the cost they bound is paid.
#pragma once

#include <cstddef>

namespace patchmill::limits {

// Wire.
inline constexpr std::size_t kMaxMessageBytes = std::size_t{64} << 20;  // either way, both ends
inline constexpr std::size_t kMaxSmallMessageBytes = 4096;              // asked of health and reflection
inline constexpr int kMaxInFlightMib =
    256;  // default of the server: of requests on their way, read, or in work, and of answers
inline constexpr std::size_t kMaxFileModelBytes = std::size_t{256}
                                                  << 20;  // in memory, of a message in a model file
inline constexpr int kReceiveSeconds = 300;         // from the start of a call until its request has come
inline constexpr int kMeasureMs = 10;               // requests on their way are measured this often
inline constexpr int kMaxCallsPerConnection = 100;  // at once; more wait at the client
inline constexpr int kMaxConnections = 10'000;      // open at once; fewer where there are fewer descriptors
inline constexpr int kSpareDescriptors = 64;        // never taken by connections
inline constexpr int kHandshakeSeconds = 20;        // from a connection until it speaks HTTP/2
inline constexpr std::size_t kChunkBytes = std::size_t{256} << 10;  // of program and artifact pieces
inline constexpr std::size_t kPathChunkPoints = 4096;               // of one PathChunk
inline constexpr std::size_t kMaxStatusBytes = 4096;  // of grpc-status-details-bin; trailers stop at 8 KiB
inline constexpr std::size_t kMaxStatusMessageBytes = 1000;
inline constexpr int kMaxViolations = 20;
inline constexpr std::size_t kMaxPictureBytes = std::size_t{8} << 20;
inline constexpr std::size_t kMaxDiagnostics = 2000;  // of one answer; the rest is counted

// Models.
inline constexpr std::size_t kMaxPatches = 100'000;
// All patches together; 100,000 bicubic ones have 1.6 million. A patch of many pieces (B-spline, Brown,
// Hosaka) counts with the points of these.
inline constexpr std::size_t kMaxControlPoints = 2'500'000;
inline constexpr std::size_t kMaxKnots = 2'500'000;  // all patches together
inline constexpr std::size_t kMaxNetworkVertices = 4 * kMaxPatches;
inline constexpr std::size_t kMaxNetworkEdges = 4 * kMaxPatches;
inline constexpr std::size_t kMaxNetworkReferences = 16 * kMaxPatches;  // vertices of faces, faces of normals
// Numbers of all lists of a request together: coordinates, weights and knots.
inline constexpr std::size_t kMaxRequestNumbers = 4 * kMaxControlPoints + kMaxKnots;
inline constexpr std::size_t kMaxIdBytes = 200;
inline constexpr std::size_t kMaxNameBytes = 100;
inline constexpr std::size_t kMaxRequestIdBytes = 128;

// Jobs.
inline constexpr int kMaxThreads = 64;            // of one job
inline constexpr int kMaxJobs = 64;               // at once, of one server
inline constexpr double kMaxJobSeconds = 3600.0;  // default of the server
// Of the passes of one plan, counted while they are made, and of the program with its links: a job that comes
// to more ends there (cam/toolpath/counted_loop.h), and one whose finish cannot take less before its passes
// are
// made (LeastCutLength). Every plan that the choice of an angle makes counts for itself. A point takes about
// 0.6
// kB of memory, and the verifier of other people's programs reads as many.
inline constexpr double kMaxCutLengthMm = 5e6;
inline constexpr double kMaxPathPoints = 5e6;
inline constexpr std::size_t kMaxOutlinePoints =
    20'000;  // of all boundary rings and obstacles of a job, each
inline constexpr int kMaxObstacles = 1000;
inline constexpr int kMaxRegionOverrides = 1000;
inline constexpr std::size_t kMaxProgramBytes = std::size_t{512} << 20;  // of a made program

// Curves.
inline constexpr std::size_t kMaxCurvePoints = 100'000;  // given; locks too
inline constexpr double kMaxPolylinePoints = 1e6;        // answered
inline constexpr double kMaxCurveCoordinate = 1e9;       // in the unit of the curve

// Lines and evaluations.
inline constexpr int kMaxLineFamilies = 20;
inline constexpr int kMaxLineLevels = 1000;  // of a family
inline constexpr int kMaxEvaluations = 200'000;

// Times of the service itself.
inline constexpr int kCancelPollMs = 50;  // a cancel is seen after at most this
inline constexpr int kHeartbeatMs = 250;  // Progress is sent this often
inline constexpr int kDrainSeconds = 10;  // from SIGTERM until running calls are cut off

// Ranges of single fields; the messages name them.
inline constexpr double kMinDiameterMm = 0.02, kMaxDiameterMm = 1000.0;
inline constexpr double kMinToleranceMm = 1e-4;
inline constexpr double kMaxLeaveMm = 100.0;
inline constexpr double kMaxAllowanceMm = 100.0;
inline constexpr double kMaxApproachGapMm = 100.0;
inline constexpr double kMaxClearanceAboveMm = 1e4;
inline constexpr double kMaxCoordinateMm = 1e5;
inline constexpr double kMaxAvoidMarginMm = 100.0;
inline constexpr double kMaxOutlineOffsetMm = 1000.0;
inline constexpr double kMinSteepDeg = 5.0, kMaxSteepDeg = 85.0;
inline constexpr double kMinRpm = 1.0, kMaxRpm = 1e6;
inline constexpr double kMinFeed = 0.1, kMaxFeed = 1e6;  // mm/min
inline constexpr int kMaxToolNumber = 99'999;
inline constexpr double kMinScale = 1e-6, kMaxScale = 1e6;
inline constexpr double kMaxJoinToleranceMm = 10.0;
inline constexpr int kMaxContinuitySteps = 10'000;

}  // namespace patchmill::limits
