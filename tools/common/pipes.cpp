#include "tools/common/pipes.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr const char* kDash = "-";

// Kinds of files that a terminal can show.
constexpr std::array<std::string_view, 5> kText = {"svg", "obj", "json", "ply", "tscn"};

[[noreturn]] void refuse(const std::string& text) {
    throw Error(ErrorKind::kBadArgument, text);
}

void read_input(const Tool& tool, FileOptions& files, StreamFile& stream, std::uint64_t most) {
    if (std::ranges::count(files.inputs, kDash) > 1) refuse("-: standard input is named twice");
    const std::string unnamed = "standard input has no name for a file in a folder";
    if (tool.fills_output && tool.fills_output())
        refuse("-: a tile set is made from a file, which can be read by parts");
    if (is_folder(files.output)) refuse(cat("-o ", files.output, ": ", unnamed));
    for (const SideFile& side : tool.sides)
        if (is_folder(*side.value)) refuse(cat(side.option, ' ', *side.value, ": ", unnamed));
    if (::isatty(STDIN_FILENO)) refuse("-: standard input is a terminal; expected a file or a pipe");
    stream.fill(STDIN_FILENO, most);
    std::array<char, 16> start = {};
    const ssize_t size = ::pread(stream.descriptor(), start.data(), start.size(), 0);
    const std::string_view text(start.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first != std::string_view::npos && text[first] == '{')
        throw Error(ErrorKind::kBadFile, cat(kStandardInput,
                                             ": looks like a .gltf, whose data is in files beside "
                                             "it; expected a .glb"));
    std::ranges::replace(files.inputs, std::string(kDash), std::string(kStandardInput));
}

}  // namespace

std::string shown_name(const std::string& output) {
    return stream_descriptor(output) >= 0 ? kStandardOutput : output;
}

Pipes::Pipes(const Tool& tool, FileOptions& files, std::uint64_t most) {
    for (const SideFile& side : tool.sides)
        if (*side.value == kDash) refuse(cat(side.option, " -: only -o writes to standard output"));
    if (files.output == kDash) {
        const std::string type = files.type.empty() ? tool.type() : files.type;
        if (files.inputs.size() > 1)
            refuse(cat("-o -: ", files.inputs.size(), " files need a folder, whose name ends with /"));
        if (type == "gltf") refuse("-o -: a .gltf needs files beside it; --format glb has all in one");
        if (files.skip_existing)
            refuse("--skip-existing: nothing is there before standard output is written");
        if (::isatty(STDOUT_FILENO) && std::ranges::find(kText, type) == kText.end())
            refuse(cat("-o -: standard output is a terminal, which cannot show .", type,
                       "; expected a file or a pipe"));
        output_ = std::make_unique<StreamFile>(cat(kStandardOutput, '.', type));
        files.output = output_->name();
        files.type.clear();
    }
    if (std::ranges::find(files.inputs, kDash) == files.inputs.end()) return;
    input_ = std::make_unique<StreamFile>(kStandardInput);
    read_input(tool, files, *input_, most);
}

void Pipes::deliver() const {
    output_->pour(STDOUT_FILENO, kStandardOutput);
}

}  // namespace imgmesh
