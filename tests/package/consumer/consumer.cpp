// A program of somebody else: an image made on the spot, its container written, read and drawn,
// and the drawing as a file that needs the installed module.
#include <iostream>
#include <string>

#include <imgmesh/container/container.h>
#include <imgmesh/picture/image_io.h>
#include <imgmesh/pipeline/build.h>
#include <imgmesh/recon/draw.h>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    imgmesh::Image image = imgmesh::make_image(32, 24, 3);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = (x < 16) == (c == 0) ? 0.8f : 0.2f;
    imgmesh::BuildParams params;
    params.stop.faces = 60;
    imgmesh::write_container(argv[1], imgmesh::build_mesh_image(image, params, {}).mesh_image);
    const imgmesh::Container read = imgmesh::read_container(argv[1]);
    const imgmesh::Image drawn = imgmesh::draw(read.mesh_image, 0, {});
    const std::string picture = std::string(argv[1]) + ".tif";
    imgmesh::write_image(picture, drawn);
    const bool same = imgmesh::read_image(picture).width == drawn.width;
    std::cout << read.mesh_image.levels[0].mesh.faces.size() << " faces, " << drawn.width << "x"
              << drawn.height << '\n';
    return same && drawn.width == 32 && drawn.height == 24 ? 0 : 1;
}
