# The public headers: what a program that links imgmesh includes, as <imgmesh/ROOM/NAME.h> or all at once as
# <imgmesh/imgmesh.h>. Nothing else is installed. A header in this list includes only others of it, Eigen and the standard
# library (tests/check_includes.py).
set(IMGMESH_PUBLIC_HEADERS
  libcore/base/error.h
  libcore/base/grid.h
  libcore/base/index.h
  libcore/base/parallel.h
  libcore/base/progress.h
  libcore/base/types.h

  libcore/image/color.h
  libcore/image/feature_space.h
  libcore/image/image.h
  libcore/image/mask.h
  libcore/image/texture_image.h

  libcore/mesh/base_mesh.h
  libcore/mesh/mesh_image.h
  libcore/mesh/outer_edge.h
  libcore/mesh/displacements.h
  libcore/mesh/pixel_map.h

  libcore/simplify/metric.h
  libcore/simplify/simplify_params.h
  libcore/refine/refine_params.h
  libcore/param/fit_map.h
  libcore/pipeline/build.h
  libcore/pipeline/build_params.h
  libcore/pipeline/presets.h
  libcore/pipeline/targets.h

  libcore/recon/draw.h
  libcore/recon/draw_channels.h

  libcore/segment/cells.h
  libcore/segment/contour_map.h
  libcore/segment/draw_regions.h
  libcore/segment/hierarchy.h
  libcore/segment/labels.h
  libcore/segment/region_colors.h
  libcore/segment/region_faces.h
  libcore/segment/region_outlines.h
  libcore/segment/regions_svg.h
  libcore/segment/seeds.h
  libcore/segment/segment.h
  libcore/segment/smooth_image.h

  libcore/warp/arap.h
  libcore/warp/displacement.h
  libcore/warp/injective.h
  libcore/warp/retarget.h
  libcore/warp/solve_edits.h
  libcore/warp/warp_edits.h
  libcore/warp/warp_image.h
  libcore/warp/warp_maps.h
  libcore/warp/warp_mesh.h

  libcore/metrics/compare_channels.h
  libcore/metrics/compare_images.h
  libcore/metrics/distribution.h
  libcore/metrics/error_image.h
  libcore/metrics/metrics.h
  libcore/metrics/quality_distributions.h
  libcore/metrics/triangle_shape.h

  libcore/coding/bitmap.h
  libcore/coding/coded_mesh.h
  libcore/coding/coded_mesh_image.h
  libcore/coding/coded_stream.h
  libcore/coding/draw_coded.h
  libcore/coding/encode_picture.h
  libcore/coding/image_bitmap.h

  formats/container/container.h
  formats/container/edit_file.h
  formats/container/validate.h
  formats/export/contour_files.h
  formats/export/label_files.h
  formats/export/mesh_arrays.h
  formats/export/mesh_export.h
  formats/export/npy.h
  formats/exr/exr_metadata.h
  formats/exr/exr_parts.h
  formats/findings/finding_codes.h
  formats/findings/issue.h
  formats/findings/limits.h
  formats/findings/place.h
  formats/gltf/draco_mode.h
  formats/gltf/layer_layout.h
  formats/gltf/region_gltf.h
  formats/picture/image_io.h
  formats/picture/region_source.h
  formats/picture/spool.h
  formats/picture/texture_file.h)

# cmake -DSOURCE=ROOT -DOUT=FOLDER -P cmake/public_headers.cmake: writes them below FOLDER/imgmesh under their public
# names, including each other by these.
if(CMAKE_SCRIPT_MODE_FILE)
  file(REMOVE_RECURSE ${OUT}/imgmesh)
  set(_all "// All public headers of imgmesh.\n#pragma once\n\n")
  foreach(_header IN LISTS IMGMESH_PUBLIC_HEADERS)
    string(REGEX REPLACE "^(libcore|formats)/" "imgmesh/" _name ${_header})
    file(READ ${SOURCE}/${_header} _text)
    string(REGEX REPLACE "#include \"(libcore|formats)/([^\"]+)\"" "#include <imgmesh/\\2>" _text "${_text}")
    file(WRITE ${OUT}/${_name} "${_text}")
    string(APPEND _all "#include <${_name}>\n")
  endforeach()
  file(WRITE ${OUT}/imgmesh/imgmesh.h "${_all}")
  return()
endif()

set(_folder ${CMAKE_BINARY_DIR}/include)
set(_stamp ${_folder}/public_headers.stamp)
list(TRANSFORM IMGMESH_PUBLIC_HEADERS PREPEND ${PROJECT_SOURCE_DIR}/ OUTPUT_VARIABLE _headers)
add_custom_command(OUTPUT ${_stamp}
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DOUT=${_folder} -P ${CMAKE_CURRENT_LIST_FILE}
  COMMAND ${CMAKE_COMMAND} -E touch ${_stamp}
  DEPENDS ${CMAKE_CURRENT_LIST_FILE} ${_headers})
add_custom_target(public_headers ALL DEPENDS ${_stamp})
install(DIRECTORY ${_folder}/imgmesh DESTINATION include)
