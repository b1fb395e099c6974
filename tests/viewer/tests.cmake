# The 3-D page: its parts, the page with made-up scenes, and pages that patchmill writes, in Chromium without a screen.
if(PATCHMILL_SERVICE AND TARGET patchmill AND PATCHMILL_NODE AND EXISTS ${CMAKE_SOURCE_DIR}/clients/viewer/node_modules/esbuild)
  set(viewer ${CMAKE_SOURCE_DIR}/clients/viewer)
  add_test(NAME viewer_types COMMAND ${PATCHMILL_NODE} ${viewer}/node_modules/typescript/bin/tsc --noEmit -p ${viewer})
  add_test(NAME viewer_page COMMAND ${PATCHMILL_NODE} --test ${viewer}/test/ WORKING_DIRECTORY ${viewer})
  add_test(NAME viewer_real_pages COMMAND ${PATCHMILL_NODE} --test ${CMAKE_CURRENT_SOURCE_DIR}/viewer/
           WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
  set_tests_properties(viewer_page viewer_real_pages PROPERTIES TIMEOUT 300
                       ENVIRONMENT "PATCHMILL_BIN=$<TARGET_FILE_DIR:patchmill>")
endif()
