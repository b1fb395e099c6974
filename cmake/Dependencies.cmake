# Debian 12's packages; scripts/setup.sh installs them. SYSTEM: their warnings are not ours.
find_package(Threads REQUIRED)
if(PATCHMILL_SERVICE)
  find_package(Protobuf 3.21 REQUIRED)  # module mode, and before gRPC
  find_package(gRPC CONFIG REQUIRED)
  find_package(CLI11 CONFIG REQUIRED)
  find_package(spdlog CONFIG REQUIRED)
  find_package(prometheus-cpp CONFIG QUIET COMPONENTS pull)  # without it patchmilld has no --metrics-listen
endif()
find_package(absl CONFIG REQUIRED)
find_package(fmt CONFIG REQUIRED)
find_package(OpenMesh CONFIG REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB CONFIG REQUIRED)
find_package(OpenSSL REQUIRED)  # libcrypto's SHA-256; gRPC links it anyway
