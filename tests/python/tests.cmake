# The Python package as a user gets it: its wheel, linters, and tests against the built programs.
if(PATCHMILL_SERVICE AND TARGET patchmill AND NOT PATCHMILL_SANITIZE AND PATCHMILL_NODE
   AND EXISTS ${CMAKE_SOURCE_DIR}/clients/viewer/node_modules/esbuild)
  add_test(NAME python_package COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/python/run.sh $<TARGET_FILE_DIR:patchmill>)
  # It measures how soon calls end.
  set_tests_properties(python_package PROPERTIES TIMEOUT 400 RUN_SERIAL TRUE)
endif()
