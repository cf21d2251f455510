# cmake -DINSTALLED=FOLDER -DSOURCE=tests/package/consumer -DWORK=FOLDER -P consumer_test.cmake: builds a program that
# finds the installed package, and runs it.
file(REMOVE_RECURSE ${WORK})
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY OUTPUT_VARIABLE out)
  message(STATUS "${out}")
endfunction()
# What only the tools and the module of OpenImageIO need must not be looked for.
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK} -G Ninja -DCMAKE_PREFIX_PATH=${INSTALLED} -DCMAKE_BUILD_TYPE=Debug
  -DCMAKE_DISABLE_FIND_PACKAGE_CLI11=ON -DCMAKE_DISABLE_FIND_PACKAGE_OpenImageIO=ON)
run(${CMAKE_COMMAND} --build ${WORK})
run(${WORK}/consumer ${WORK}/x.glb)
run(${INSTALLED}/bin/imgmesh-info ${WORK}/x.glb --validate --warnings-as-errors)
file(REMOVE_RECURSE ${WORK})
