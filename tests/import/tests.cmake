if(TARGET pm_import)
  patchmill_test(import EXTERNAL pm_import)
endif()
