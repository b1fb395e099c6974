find_package(Python3 COMPONENTS Interpreter REQUIRED)
add_test(NAME posts_control_rules COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/posts/control_rules_test.py)
if(TARGET patchmill AND NOT PATCHMILL_SANITIZE)
  add_test(NAME posts_all_dialects COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/posts/all_dialects.py
                                           $<TARGET_FILE:patchmill>)
  set_tests_properties(posts_all_dialects PROPERTIES TIMEOUT 600)
endif()
