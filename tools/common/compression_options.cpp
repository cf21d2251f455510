#include "tools/common/compression_options.h"

#include "tools/common/help.h"
#include "tools/common/names.h"

namespace imgmesh {

void add_compression_options(CLI::App& app, CompressionOptions& options, const std::string& otherwise,
                             const std::string& layers_otherwise) {
    const std::string group = "Container";
    advanced(app, in_group(add_choice(app, "--draco", options.draco, draco_choices(),
                                      {"Compression of the meshes by Draco", otherwise}),
                           group));
    CLI::Option* const method = add_choice(
        app, "--compression", options.method,
        Choices<Compression>{
            {"draco", Compression::kDraco}, {"meshopt", Compression::kMeshopt}, {"none", Compression::kOff}},
        {"Compression of the meshes: draco, meshopt for engines without Draco and only with --no-map, or "
         "none",
         "as --draco says"});
    exclude(app, in_group(method, group), {"--draco"});
    advanced(app, in_group(add_choice(app, "--layers", options.layers, layer_choices(),
                                      {"How the pixel maps are stored: exr, which other programs read, or "
                                       "compact, a sixth of the bytes",
                                       layers_otherwise}),
                           group));
}

void check_compression(const CompressionOptions& options, bool with_map) {
    if (with_map && options.method == Compression::kMeshopt)
        throw Error(ErrorKind::kBadArgument,
                    "--compression meshopt: only for meshes without a pixel map, which --no-map writes");
    if (!with_map && options.layers)
        throw Error(ErrorKind::kBadArgument,
                    "--layers: there are no layers without a pixel map (--no-map, --outline-tolerance)");
}

void compress(ContainerOptions& container, const CompressionOptions& options, DracoMode otherwise) {
    container.draco = options.draco.value_or(otherwise);
    if (!options.method) return;
    container.meshopt = options.method == Compression::kMeshopt;
    // With Draco the mode stays that of the input, if it has one.
    if (options.method == Compression::kDraco && otherwise == DracoMode::kOff)
        container.draco = DracoMode::kEdgebreaker;
    if (options.method == Compression::kOff) container.draco = DracoMode::kOff;
}

}  // namespace imgmesh
