// imgmesh-encode: images in, coded pictures out.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>

#include "formats/container/container.h"
#include "formats/files/atomic_file.h"
#include "formats/files/extension.h"
#include "libcore/coding/coded_stream.h"
#include "libcore/coding/encode_picture.h"
#include "libcore/coding/image_bitmap.h"
#include "libcore/recon/draw.h"
#include "tools/common/container_input.h"
#include "tools/common/help.h"
#include "tools/common/in_file.h"
#include "tools/common/limits.h"
#include "tools/common/memory.h"
#include "tools/common/names.h"
#include "tools/common/options.h"
#include "tools/common/other_tool.h"
#include "tools/common/output.h"
#include "tools/common/read_options.h"
#include "tools/common/targets.h"
#include "tools/common/text.h"
#include "tools/common/tool_main.h"

using namespace imgmesh;

namespace {

// What encoding takes beside the image [bytes a pixel], the weights of pixels for SSIM, and drawing a
// container; measured as in docs/limits.md.
constexpr double kEncodeBytes = 100, kWeightBytes = 40, kDrawBytes = 50;

struct Options {
    std::string input;
    std::string output;
    EncodeParams params;
    bool strict = false;
    ReadImageOptions read;
    ContainerLimits limits;
};

void add_options(CLI::App& app, Options& o) {
    const std::string size = "Size", work = "Encoding";
    EncodeParams& p = o.params;
    in_group(add_count(app, "--bytes", p.bytes, {1},
                       "Largest size of the file, which gets as good as that allows"),
             size);
    CLI::Option* const psnr = in_group(add_number(app, "--psnr", p.psnr, {1, kMostPsnr},
                                                  "Error to keep to, over all channels, 1 to 100 [dB]"),
                                       size);
    CLI::Option* const vertices =
        in_group(add_count(app, "--vertices", p.vertices, {4}, "Number of vertices, at least 4"), size);
    CLI::Option* const quality = in_group(
        add_number(app, "--quality", p.quality, {0, kMostQuality},
                   {"Vertices for each pixel, 0 to 100: 50 is one for 108 pixels, and 8 more doubles them",
                    cat(kUsualQuality)}),
        size);
    exclude(app, psnr, {"--bytes"});
    exclude(app, vertices, {"--bytes", "--psnr"});
    exclude(app, quality, {"--bytes", "--psnr", "--vertices"});
    in_group(
        add_count(app, "--effort", p.effort, {1, kMostEffort},
                  "Time for a better file, 1 to 5; each takes up to four times as long as the one before"),
        work);
    in_group(add_choice(app, "--tune", p.tune, tune_choices(),
                        "Error to keep low (psnr: all channels alike; luma: brightness first; ssim: as luma, "
                        "and more in smooth areas)"),
             work);
    add_strict_option(app, o.strict);
    o.read.channels.emplace();  // the colour and alpha
    add_read_options(app, o.read, nullptr, true);
    add_container_limits(app, o.limits);
}

void check_options(const Options& o) {
    if (lower_extension(o.output) != ".imgm")
        throw Error(ErrorKind::kBadArgument, cat("-o ", o.output, ": expected a name in .imgm, or a folder",
                                                 other_tool("imgmesh-encode", o.output)));
}

// Says what 8 bits of sRGB do not hold.
void tell_rounding(const Options& o, const Image& image, std::vector<std::string>& warnings) {
    if (image.sample_type == SampleType::kUint8) return;
    const bool bright = image.sample_type != SampleType::kUint16 &&
                        std::ranges::any_of(image.data, [](float sample) { return sample > 1; });
    warnings.push_back(cat(o.input, ": samples of type ", name_of(sample_type_choices(), image.sample_type),
                           bright ? " are clipped and rounded" : " are rounded", " to 8 bits"));
}

double encode_bytes(const EncodeParams& params) {
    return kEncodeBytes + (params.tune == Tune::kSsim ? kWeightBytes : 0);
}

// Returns the picture itself, or what imgmesh-reconstruct draws of a container.
Bitmap read_picture(const Options& o, Context& context) {
    Image image;
    if (is_container(o.input)) {
        const MeshImage m =
            read_container(o.input, container_limits(o.limits, context.max_memory)).mesh_image;
        context.memory.take_for(o.input, m, encode_bytes(o.params) + kDrawBytes);
        if (split_names(m.source.channel_names).color.empty())
            throw Error(ErrorKind::kUnsupported, cat(o.input, ": the container has no colour to encode"));
        image = draw(m, 0, {});
    } else {
        ReadImageOptions read = image_options(o.read, o.limits, context.max_memory);
        read.limits.work_bytes = encode_bytes(o.params);
        image = read_with_warnings(o.input, read, context.warnings).image;
        context.memory.take(cat(o.input, ": encoding ", image.width, "x", image.height, " pixels"),
                            kProgramMemory + static_cast<double>(image.pixel_count()) *
                                                 (encode_bytes(o.params) + 8.0 * image.channels));
    }
    if (static_cast<std::int64_t>(image.pixel_count()) > coding::kMaxPixels)
        throw Error(ErrorKind::kUnsupported, cat(o.input, ": has ", image.width, "x", image.height,
                                                 " pixels, a coded picture at most ", coding::kMaxPixels));
    tell_rounding(o, image, context.warnings);
    return in_file(o.input, [&] { return bitmap_from_image(image); });
}

std::vector<std::string> missed_targets(const EncodeParams& params, const EncodeReport& report) {
    if (report.reached) return {};
    if (params.psnr)
        return {cat("a PSNR of ", *params.psnr, " dB was wanted, the file has ", format_number(report.psnr))};
    return {cat(params.vertices.value_or(0), " vertices were wanted, the mesh has ", report.vertices)};
}

Report encode_one(const Options& o, Context& context) {
    check_output(o.output, context.overwrite);
    EncodeParams params = o.params;
    if (!params.bytes && !params.psnr && !params.vertices && !params.quality) params.quality = kUsualQuality;
    const Bitmap picture = read_picture(o, context);
    const EncodedPicture encoded =
        in_file(o.input, [&] { return encode_picture(picture, params, context.progress); });
    const EncodeReport& result = encoded.report;
    const std::vector<std::string> missed = missed_targets(params, result);
    tell_missed(o.input, missed, o.strict, context.warnings);
    AtomicFile file(o.output, context.overwrite);
    file.write(encoded.bytes);
    file.commit();
    Report report = {{"input", o.input},
                     {"output", o.output},
                     {"width", picture.width},
                     {"height", picture.height},
                     {"channels", make_image(1, 1, picture.channels).channel_names},
                     {"vertices", result.vertices},
                     {"faces", result.faces},
                     {"grid_step", result.grid_step},
                     {"psnr", nullptr},
                     {"bytes", encoded.bytes.size()},
                     {"header_bytes", result.header_bytes},
                     {"point_bytes", result.point_bytes},
                     {"face_bytes", result.face_bytes},
                     {"color_bytes", result.color_bytes}};
    if (std::isfinite(result.psnr)) report["psnr"] = result.psnr;
    report.update(target_report(missed));
    return report;
}

std::string error_text(const Report& report) {
    const Report& psnr = report["psnr"];
    return psnr.is_null() ? "equal to the image" : cat(format_number(psnr.get<double>()), " dB");
}

void print(const Report& report, std::ostream& out) {
    const auto bytes = [&](const char* part) { return report[part].get<std::uint64_t>(); };
    out << printable_line(report["input"].get<std::string>() + " -> " + report["output"].get<std::string>())
        << '\n';
    const double pixels = report["width"].get<double>() * report["height"].get<double>();
    TextTable table;
    table.add("size", cat(report["width"], " x ", report["height"], " pixels"));
    table.add("mesh", cat(report["vertices"], " vertices, ", report["faces"], " faces, on a grid of ",
                          format_number(report["grid_step"].get<double>()), " pixels"));
    table.add("error", error_text(report));
    table.add("file",
              cat(format_bytes(bytes("bytes")), ", ",
                  format_number(8 * static_cast<double>(bytes("bytes")) / pixels),
                  " bits a pixel: positions ", format_bytes(bytes("point_bytes")), ", faces ",
                  format_bytes(bytes("face_bytes")), ", colours ", format_bytes(bytes("color_bytes"))));
    table.print(out, 2);
}

std::string line(const Report& report) {
    return cat(report["vertices"], " vertices, ", error_text(report), ", ",
               format_bytes(report["bytes"].get<std::uint64_t>()));
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    return tool_main<Options>(
        {.name = "imgmesh-encode",
         .description = "Turn images into coded pictures: meshes of a few kilobytes.",
         .input_name = "IMAGE",
         .input_help = "Images to read, or containers (.glb, .gltf), whose reconstruction is encoded",
         .output_help =
             "Coded picture to write (.imgm), or a folder, ended by /, for NAME.imgm of each image",
         .type = [] { return "imgm"; },
         .instead_of_sets = "imgmesh-reconstruct draws it as a picture first"},
        {add_options, check_options, encode_one, print, line}, options, argc, argv);
}
