# cmake -DINSTALLED=FOLDER -DSOURCE=tests/package/consumer -DWORK=FOLDER -P consumer_test.cmake: builds a program that
# finds the installed package, and runs it.
file(REMOVE_RECURSE ${WORK})
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE out)
  message(STATUS "${out}")
endfunction()
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK} -G Ninja -DCMAKE_PREFIX_PATH=${INSTALLED} -DCMAKE_BUILD_TYPE=Debug)
run(${CMAKE_COMMAND} --build ${WORK})
run(${WORK}/consumer ${WORK}/x.glb)
run(${INSTALLED}/bin/imgmesh-info ${WORK}/x.glb --validate --warnings-as-errors)
file(REMOVE_RECURSE ${WORK})
