patchmill_test(clients/render DEPS clients/render)
if(PATCHMILL_SERVICE)
  patchmill_test(clients/cli EXTERNAL pm_proto)
  if(TARGET clients_cli_tests)  # the tsan preset has none
    target_sources(clients_cli_tests PRIVATE ${CMAKE_SOURCE_DIR}/clients/cli/scene_arrays.cc)
  endif()
endif()
