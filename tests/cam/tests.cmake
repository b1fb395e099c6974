foreach(folder tool toolpath location region path link post verify picture)
  patchmill_test(cam/${folder} DEPS cam/plan)
endforeach()
patchmill_test(cam/plan DEPS cam/plan tests/support/jobs)
