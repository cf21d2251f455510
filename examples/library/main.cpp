// imgmesh-example IMAGE FOLDER: builds a container from an image, reads it back, draws it, warps the image.
#include <imgmesh/imgmesh.h>

#include <iostream>
#include <string>

int main(int argc, char** argv) try {
    if (argc != 3) return std::cerr << "usage: imgmesh-example IMAGE FOLDER\n", 2;
    const std::string folder = std::string(argv[2]) + "/";

    // Build: 1000 vertices stand for the image; every pixel knows its triangle and its place in it.
    const imgmesh::Image image = imgmesh::read_image(argv[1]);
    imgmesh::BuildParams params;
    params.stop.vertices = 1000;
    const imgmesh::BuildResult built = imgmesh::build_mesh_image(image, params);
    imgmesh::write_container(folder + "image.glb", built.mesh_image);

    // Read and draw: the pixel map restores the edges that the mesh alone would blur.
    const imgmesh::MeshImage mesh_image = imgmesh::read_container(folder + "image.glb").mesh_image;
    imgmesh::write_image(folder + "drawn.png", imgmesh::draw(mesh_image, 0, {}));
    std::cout << mesh_image.levels[0].mesh.faces.size() << " faces, RMS " << built.report.levels[0].map_rms
              << " in L*u*v*\n";

    // Warp: pull the vertex nearest to the middle to the right by a tenth of the width; the sides stay.
    imgmesh::WarpEdit edit;
    edit.solver = imgmesh::WarpSolver::kArap;
    edit.pins.emplace_back().border = true;
    imgmesh::WarpHandle& handle = edit.handles.emplace_back();
    handle.vertices.near = imgmesh::Vec2d(image.width / 2.0, image.height / 2.0);
    handle.move = imgmesh::Vec2d(image.width / 10.0, 0);
    const auto field = imgmesh::displacement_field(mesh_image, imgmesh::solve_edits(mesh_image, {edit}));
    imgmesh::write_image(folder + "warped.png", imgmesh::warp_image(image, field));
    return 0;
} catch (const imgmesh::Error& error) {  // one line: the file, what was found and what was expected
    return std::cerr << error.what() << '\n', 1;
}
