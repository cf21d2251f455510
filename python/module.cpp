// imgmesh._imgmesh: the libraries as a Python module. The package imgmesh names what of it is public.
#include "python/bind.h"
#include "python/work.h"

PYBIND11_MODULE(_imgmesh, module) {
    using namespace imgmesh::python;
    module.attr("__version__") = IMGMESH_VERSION;
    stop_work_at_exit();
    bind_errors(module);
    bind_image(module);
    bind_container(module);
    bind_build(module);
    bind_draw(module);
    bind_segment(module);
    bind_warp(module);
    bind_compare(module);
    bind_coded(module);
}
