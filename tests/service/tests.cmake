if(PATCHMILL_SERVICE)
  patchmill_test(service DEPS cam/plan EXTERNAL pm_server)
  add_dependencies(service_tests patchmill_descriptors patchmill patchmilld)
  if(TARGET patchmill-import)
    add_dependencies(service_tests patchmill-import)
  endif()
  target_compile_definitions(service_tests PRIVATE PATCHMILL_DESCRIPTORS="${CMAKE_BINARY_DIR}/patchmill_v1.binpb"
                                                   PATCHMILL_BIN="${CMAKE_BINARY_DIR}/bin")
  # These measure times or start processes; a neighbour would spoil them.
  foreach(test service_call_test service_generate_program_test service_cli_test service_cli_files_test
               service_daemon_limits_test service_daemon_memory_test service_daemon_idle_test service_daemon_places_test
               service_daemon_kills_test)
    if(TEST ${test})  # the tsan preset has only some
      set_tests_properties(${test} PROPERTIES RUN_SERIAL TRUE)
    endif()
  endforeach()

  add_test(NAME lint_buf COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/lint/buf.sh ${CMAKE_SOURCE_DIR})
  set_tests_properties(lint_buf PROPERTIES SKIP_RETURN_CODE 77)
  add_test(NAME service_python_client COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/service/python_client.sh
           ${CMAKE_SOURCE_DIR} ${CMAKE_BINARY_DIR}/bin/patchmilld)
  set_tests_properties(service_python_client PROPERTIES SKIP_RETURN_CODE 77)
endif()
