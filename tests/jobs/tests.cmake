# The jobs that must work from a fresh clone: real models through the command line, the interpreter and the verifier.
if(PATCHMILL_SERVICE AND NOT PATCHMILL_SANITIZE)
  function(patchmill_job name model)
    add_test(NAME job_${name} COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/jobs/run_job.sh $<TARGET_FILE:patchmill>
                                      ${CMAKE_SOURCE_DIR}/${model} ${ARGN})
    set_tests_properties(job_${name} PROPERTIES TIMEOUT 300)
  endfunction()
  patchmill_job(teapot examples/teapot.bpt --up y --scale 50 --tool-diameter 6 --scallop 0.02)
  patchmill_job(two_hills examples/two_hills.bv)
  patchmill_job(two_hills_steep examples/two_hills.bv --steep-angle 30)
  set_tests_properties(job_two_hills_steep PROPERTIES ENVIRONMENT "MUST_CONTAIN=contour passes")
  patchmill_job(teacup tests/models/teacup.bpt --up y --scale 50 --tool-diameter 6 --scallop 0.02)
  patchmill_job(torus_bicubic tests/models/torus_bicubic.patches --up y --scale 40 --tool-diameter 6 --scallop 0.02)
  patchmill_job(toroidal_tet tests/models/toroidal_tet.patches --up y --scale 40 --tool-diameter 6 --scallop 0.02)
  patchmill_job(triangle_fan tests/models/triangle_fan.bv --up y --scale 40 --tool-diameter 6 --scallop 0.02)
  patchmill_job(mouse examples/mouse.json --tool-diameter 6 --scallop 0.02)
  patchmill_job(bonnet examples/bonnet.json --tool-diameter 6 --scallop 0.02)
  patchmill_job(sheet docs/sheet.json --tool-diameter 6 --scallop 0.02)
  patchmill_job(sphere tests/models/sphere.bv --scale 20 --tool-diameter 6 --scallop 0.02)

  # The commands of README and reference do what they say there.
  set(page_of_pages)
  if(PATCHMILL_NODE AND EXISTS ${CMAKE_SOURCE_DIR}/clients/viewer/node_modules/esbuild)
    set(page_of_pages docs/page.md)
  endif()
  foreach(page ${page_of_pages} README.md docs/curves.md docs/patches.md docs/networks.md docs/curvature.md docs/editing.md
          docs/first_surfaces.md docs/strokes.md docs/sections_to_part.md docs/fairing.md docs/evaluation.md docs/lines.md docs/regions.md docs/reach.md
          docs/limits.md docs/commands.md)
    get_filename_component(name ${page} NAME_WE)
    add_test(NAME job_page_${name} COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/jobs/run_page.sh $<TARGET_FILE:patchmill>
                                           ${CMAKE_SOURCE_DIR} ${page})
    set_tests_properties(job_page_${name} PROPERTIES TIMEOUT 300)
  endforeach()
endif()
