patchmill_test(property DEPS cam/plan tests/support/jobs)
# It measures how soon a cancel is obeyed and progress told; a neighbour would spoil that.
set_tests_properties(property_cancel_test PROPERTIES RUN_SERIAL TRUE)
