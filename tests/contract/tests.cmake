# The pages of the contract, and its worked requests against the built server.
if(PATCHMILL_SERVICE AND TARGET patchmilld AND NOT PATCHMILL_SANITIZE)
  add_test(NAME contract_pages COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/contract/run.sh $<TARGET_FILE:patchmilld>)
  set_tests_properties(contract_pages PROPERTIES TIMEOUT 120)
endif()
