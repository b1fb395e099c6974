foreach(folder tool toolpath location region path link post verify picture plan)
  patchmill_test(cam/${folder} DEPS cam/plan)
endforeach()
