# cmake -DBUILD=build/dev -DINSTALLED=FOLDER -P install_test.cmake: installs, and looks at the tools, man pages and
# completions.
file(REMOVE_RECURSE ${INSTALLED})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${INSTALLED} COMMAND_ERROR_IS_FATAL ANY
  OUTPUT_QUIET)
file(GLOB_RECURSE _codecs ${INSTALLED}/lib/*/imgmesh-codecs)
if(NOT _codecs)
  message(FATAL_ERROR "not installed: imgmesh-codecs")
endif()
foreach(_tool build reconstruct info compare convert warp segment)
  foreach(_file bin/imgmesh-${_tool} share/man/man1/imgmesh-${_tool}.1 share/bash-completion/completions/imgmesh-${_tool}
      share/zsh/site-functions/_imgmesh-${_tool} share/fish/vendor_completions.d/imgmesh-${_tool}.fish)
    if(NOT EXISTS ${INSTALLED}/${_file})
      message(FATAL_ERROR "not installed: ${_file}")
    endif()
  endforeach()
  file(READ ${INSTALLED}/share/man/man1/imgmesh-${_tool}.1 _page)
  if(NOT _page MATCHES "\\.B \\\\-\\\\-json")
    message(FATAL_ERROR "the man page of imgmesh-${_tool} does not tell of --json")
  endif()
endforeach()
