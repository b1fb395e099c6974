foreach(folder base math curve patch diffgeo network joining surface io)
  patchmill_test(core/${folder} DEPS core/${folder})
endforeach()
