foreach(folder base math curve patch diffgeo spatial network joining editing fairing surface lines io)
  patchmill_test(core/${folder} DEPS core/${folder})
endforeach()
