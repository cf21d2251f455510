# cmake --install: the tools, the libraries as a package for find_package(imgmesh), schemas, manuals; cpack: a .deb.
include(CMakePackageConfigHelpers)

set(_tools imgmesh-build imgmesh-reconstruct imgmesh-info imgmesh-compare imgmesh-convert imgmesh-warp imgmesh-segment
  imgmesh-encode imgmesh-decode)
set(_libraries imgmesh_core imgmesh_files imgmesh_findings imgmesh_exr imgmesh_picture imgmesh_gltf imgmesh_compact
  imgmesh_container imgmesh_tileset imgmesh_export imgmesh_formats imgmesh_pictures imgmesh_compiler)
install(TARGETS ${_tools} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
foreach(_library IN LISTS _libraries)
  string(REPLACE "imgmesh_" "" _name ${_library})
  set_target_properties(${_library} PROPERTIES EXPORT_NAME ${_name})
endforeach()
install(TARGETS ${_libraries} EXPORT imgmesh-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS imgmesh_codecs RUNTIME DESTINATION ${IMGMESH_PRIVATE_DIR})
install(FILES packaging/codecs_path.cpp DESTINATION ${IMGMESH_PRIVATE_DIR})
set(_package ${CMAKE_INSTALL_LIBDIR}/cmake/imgmesh)
install(EXPORT imgmesh-targets NAMESPACE imgmesh:: DESTINATION ${_package})
configure_file(packaging/imgmesh-config.cmake.in packaging/imgmesh-config.cmake @ONLY)
write_basic_package_version_file(packaging/imgmesh-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  ${CMAKE_CURRENT_BINARY_DIR}/packaging/imgmesh-config.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/packaging/imgmesh-config-version.cmake
  cmake/dependencies.cmake
  DESTINATION ${_package})
include(cmake/public_headers.cmake)
install(DIRECTORY schemas/ DESTINATION ${CMAKE_INSTALL_DATADIR}/imgmesh/schemas FILES_MATCHING PATTERN "*.schema.json"
  PATTERN examples EXCLUDE)
# README and the pages refer to each other by these paths.
install(FILES README.md CHANGELOG.md CONTRIBUTING.md LICENSE SECURITY.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs examples DESTINATION ${CMAKE_INSTALL_DOCDIR} PATTERN "make_*.py" EXCLUDE)

# Man pages and completions say what --help-all says.
find_program(IMGMESH_PYTHON3 python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED)
set(_manuals ${CMAKE_CURRENT_BINARY_DIR}/manuals)
set(_programs "")
foreach(_tool IN LISTS _tools)
  list(APPEND _programs $<TARGET_FILE:${_tool}>)
endforeach()
add_custom_command(OUTPUT ${_manuals}/stamp
  COMMAND ${IMGMESH_PYTHON3} ${PROJECT_SOURCE_DIR}/packaging/make_manuals.py ${_manuals} ${_programs}
  COMMAND ${CMAKE_COMMAND} -E touch ${_manuals}/stamp
  DEPENDS ${_tools} packaging/make_manuals.py packaging/completions.py)
add_custom_target(manuals ALL DEPENDS ${_manuals}/stamp)
install(DIRECTORY ${_manuals}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR})
install(DIRECTORY ${_manuals}/bash/ DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(DIRECTORY ${_manuals}/fish/ DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
# Debian's zsh looks into another folder below /usr than all others do, and than itself does below /usr/local.
install(CODE "set(_zsh site-functions)
  if(CMAKE_INSTALL_PREFIX STREQUAL /usr)
    set(_zsh vendor-completions)
  endif()
  file(INSTALL \"${_manuals}/zsh/\" DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/zsh/\${_zsh}\")")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME imgmesh)
set(CPACK_PACKAGE_CONTACT "the imgmesh maintainers <imgmesh@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
if(IMGMESH_PYTHON_MODULE)
  set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3-numpy")
endif()
set(CPACK_STRIP_FILES ON)
include(CPack)
