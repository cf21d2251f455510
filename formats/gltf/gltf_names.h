// Names that writer and reader of the JSON share.
#pragma once

namespace imgmesh {

inline constexpr const char* kPixelMap = "IMGMESH_pixel_map";
inline constexpr const char* kDraco = "KHR_draco_mesh_compression";
inline constexpr const char* kMeshopt = "EXT_meshopt_compression";
inline constexpr const char* kUnlit = "KHR_materials_unlit";
inline constexpr const char* kLod = "MSFT_lod";
/// The vertices' colours in a container with a texture, which viewers would multiply by COLOR_0.
inline constexpr const char* kHiddenColor = "_COLOR";
inline constexpr const char* kTexcoord = "TEXCOORD_0";
/// The attribute of linear RGB in HDR meshes.
inline constexpr const char* kHdr = "_LIGHT";
inline constexpr const char* kGenerator = "generator";
/// In the order of SampleType.
inline constexpr const char* kSampleTypes[] = {"uint8", "uint16", "half", "float"};

}  // namespace imgmesh
