# The service as an operator sees it: callers and quotas, certificates, metrics, logs, configuration, files of deploy.
if(PATCHMILL_SERVICE)
  patchmill_test(operations EXTERNAL pm_server)
  if(TARGET patchmilld AND NOT PATCHMILL_SANITIZE)
    add_test(NAME operations_python COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/operations/run.sh ${CMAKE_BINARY_DIR}/bin)
    set_tests_properties(operations_python PROPERTIES TIMEOUT 300 RUN_SERIAL TRUE)
  endif()
endif()
