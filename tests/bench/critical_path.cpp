// How much faster more threads can make a build, as far as its own structure goes: a machine with two cores
// cannot show what eight would do.
//
//     critical-path PICTURE FOLDER PRESET DENSITY    each stage on 1, 2, 4 and 8 threads
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "formats/container/container.h"
#include "formats/picture/image_io.h"
#include "libcore/base/error.h"
#include "libcore/pipeline/build.h"
#include "libcore/pipeline/presets.h"
#include "tests/bench/recorded_parallel.h"
#include "tools/common/huge_pages.h"

using namespace imgmesh;
using namespace imgmesh::bench;

namespace {

constexpr int kThreads[] = {1, 2, 4, 8};

void print(const StageRecord& record) {
    std::printf("%-10s %8.3f", record.stage.c_str(), record.alone);
    for (const int threads : kThreads) std::printf(" %8.3f", time_on(record, threads));
    for (const int threads : kThreads)
        if (threads > 1) std::printf(" %6.2f", time_on(record, 1) / time_on(record, threads));
    std::puts("");
}

void measure(const std::string& picture, const std::string& folder, const BuildParams& params) {
    begin_stage("read");
    const Image image = read_image(picture);
    begin_stage("collapse");  // with L*u*v*, as in BuildSeconds
    const BuildResult built = build_mesh_image(image, params, [](double, std::string_view stage) {
        if (stage != "done") begin_stage(std::string(stage));
    });
    begin_stage("write");
    write_container((std::filesystem::path(folder) / "critical-path.glb").string(), built.mesh_image);
    std::puts(
        "stage         alone      1        2        4        8 threads [s]     2      4      8 times as "
        "fast");
    StageRecord whole{"all", 0, {}};
    for (const StageRecord& record : finish_stages()) {
        print(record);
        whole.alone += record.alone;
        whole.loops.insert(whole.loops.end(), record.loops.begin(), record.loops.end());
    }
    print(whole);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 5) {
        std::fputs("usage: critical-path PICTURE FOLDER PRESET DENSITY\n", stderr);
        return 2;
    }
    use_huge_pages();  // as the tools do
    try {
        BuildParams params = preset_params(argv[3]);
        params.stop.density = std::strtod(argv[4], nullptr);
        measure(argv[1], argv[2], params);
    } catch (const Error& e) {
        std::fprintf(stderr, "critical-path: error: %s\n", e.what());
        return 1;
    }
    return 0;
}
