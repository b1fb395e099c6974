foreach(folder base math curve patch diffgeo network joining fairing surface lines io)
  patchmill_test(core/${folder} DEPS core/${folder})
endforeach()
