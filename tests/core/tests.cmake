foreach(folder base math curve patch diffgeo network joining editing fairing surface lines io)
  patchmill_test(core/${folder} DEPS core/${folder})
endforeach()
