foreach(folder base math curve patch diffgeo spatial network joining crossing division editing fairing surface lines io trim)
  patchmill_test(core/${folder} DEPS core/${folder})
endforeach()
