patchmill_test(property DEPS cam/plan tests/support/jobs)
