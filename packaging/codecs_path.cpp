// Compiled into every program that links imgmesh::pictures from an installed package: where the package has
// the program that imgmesh starts to decode and encode images.
extern "C" __attribute__((weak)) const char* imgmesh_linked_codecs() {
    return IMGMESH_LINKED_CODECS;
}
