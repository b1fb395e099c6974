# The worked requests of the contract against the built server.
if(PATCHMILL_SERVICE AND TARGET patchmilld AND NOT PATCHMILL_SANITIZE)
  add_test(NAME contract_requests COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/contract/run.sh $<TARGET_FILE:patchmilld>)
  set_tests_properties(contract_requests PROPERTIES TIMEOUT 120)
endif()
