foreach(folder base math curve patch diffgeo spatial network joining crossing division exchange editing preview fairing surface lines io trim)
  patchmill_test(core/${folder} DEPS core/${folder})
endforeach()
