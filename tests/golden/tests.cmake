# The gate: 27 jobs through the service, their answers pinned (README.md here).
if(PATCHMILL_SERVICE)
  patchmill_library(tests/support/golden DEPS core/base EXTERNAL pm_proto pm_proto_json)
  patchmill_test(golden DEPS tests/support/golden EXTERNAL pm_server)
  # Of the file alone: its program lends its precompiled headers to others.
  set_property(SOURCE ${CMAKE_CURRENT_LIST_DIR}/jobs_test.cc APPEND
               PROPERTY COMPILE_DEFINITIONS PATCHMILL_GOLDEN_OUT="${CMAKE_BINARY_DIR}/golden")
endif()
