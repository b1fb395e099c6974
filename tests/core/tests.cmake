foreach(folder base math curve patch diffgeo network joining fairing surface io)
  patchmill_test(core/${folder} DEPS core/${folder})
endforeach()
