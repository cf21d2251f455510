# Everything comes from the distribution; `./run setup` installs it.
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(TBB REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(TinyGLTF CONFIG REQUIRED)
find_package(draco CONFIG REQUIRED)
find_package(OpenEXR CONFIG REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(CLI11 CONFIG REQUIRED)

# Debian's OpenImageIO names include folders (/usr/include/opencv4) that its package does not bring; CMake would
# refuse to generate. Keep those that exist.
find_package(OpenImageIO CONFIG REQUIRED)
get_target_property(_dirs OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
set(_existing "")
foreach(_dir IN LISTS _dirs)
  if(IS_DIRECTORY ${_dir})
    list(APPEND _existing ${_dir})
  endif()
endforeach()
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${_existing}")

find_package(PNG REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(WebP REQUIRED IMPORTED_TARGET libwebp libwebpdemux)
pkg_check_modules(Deflate REQUIRED IMPORTED_TARGET libdeflate)
