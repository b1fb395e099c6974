find_package(Python3 COMPONENTS Interpreter REQUIRED)
add_test(NAME lint_layers COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/lint/layers.py ${CMAKE_SOURCE_DIR})
add_test(NAME lint_format COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/lint/format.sh ${CMAKE_SOURCE_DIR})
add_test(NAME lint_traces COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/lint/traces.sh ${CMAKE_SOURCE_DIR})
