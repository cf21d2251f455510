#include "formats/exr/exr_output.h"

#include <openexr.h>

#include <cstring>
#include <new>

#include "formats/exr/exr_part_checks.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

void check(exr_result_t result) {
    if (result != EXR_ERR_SUCCESS)
        throw Error(ErrorKind::kInternal,
                    cat("OpenEXR cannot encode the layers: ", exr_get_default_error_message(result)));
}

// OpenEXR also returns its errors as results; its handler would print them.
void say_nothing(exr_const_context_t, exr_result_t, const char*) {}

std::int64_t write_to_memory(exr_const_context_t context, void* target, const void* data, std::uint64_t size,
                             std::uint64_t offset, exr_stream_error_func_ptr_t error) {
    auto& bytes = *static_cast<std::vector<std::uint8_t>*>(target);
    try {
        if (offset + size > bytes.size()) bytes.resize(offset + size);
    } catch (const std::bad_alloc&) {
        error(context, EXR_ERR_OUT_OF_MEMORY, "out of memory");
        return -1;
    }
    std::memcpy(bytes.data() + offset, data, size);
    return static_cast<std::int64_t>(size);
}

exr_attr_box2i_t box_of(const ExrWindow& window) {
    return {{window.min_x, window.min_y}, {window.max_x, window.max_y}};
}

}  // namespace

class ExrOutput::File {
  public:
    explicit File(std::vector<std::uint8_t>& bytes) {
        exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
        start.error_handler_fn = say_nothing;
        start.user_data = &bytes;
        start.write_fn = write_to_memory;
        check(exr_start_write(&context_, "layers", EXR_WRITE_FILE_DIRECTLY, &start));
    }
    ~File() {
        if (context_) exr_finish(&context_);
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;

    exr_context_t get() const { return context_; }
    void finish() { check(exr_finish(&context_)); }
    bool has_header = false;

  private:
    exr_context_t context_ = nullptr;
};

ExrOutput::ExrOutput(std::vector<std::uint8_t>& bytes) : file_(std::make_unique<File>(bytes)) {}

ExrOutput::~ExrOutput() = default;

void ExrOutput::add_part(const ExrPartHeader& part) {
    const exr_context_t file = file_->get();
    const exr_attr_box2i_t shown = box_of(part.shown), data = box_of(part.data);
    constexpr exr_attr_v2f_t kCentre = {};
    int index = 0;
    check(exr_add_part(file, part.name->c_str(), EXR_STORAGE_SCANLINE, &index));
    check(exr_initialize_required_attr(file, index, &shown, &data, 1, &kCentre, 1, EXR_LINEORDER_INCREASING_Y,
                                       static_cast<exr_compression_t>(part.compression)));
    if (part.version) check(exr_attr_set_string(file, index, kVersionName, part.version->c_str()));
    if (part.topology) check(exr_attr_set_string(file, index, kTopologyName, part.topology->c_str()));
    for (const ExrPartChannel& c : part.channels)
        check(exr_add_channel(file, index, c.name.c_str(),
                              static_cast<exr_pixel_type_t>(static_cast<int>(c.type)),
                              c.is_linear ? EXR_PERCEPTUALLY_LINEAR : EXR_PERCEPTUALLY_LOGARITHMIC,
                              c.x_sampling, c.y_sampling));
}

void ExrOutput::write_block(std::size_t part, int row, std::span<const std::uint8_t> packed) {
    if (!file_->has_header) check(exr_write_header(file_->get()));
    file_->has_header = true;
    check(exr_write_scanline_chunk(file_->get(), static_cast<int>(part), row, packed.data(), packed.size()));
}

void ExrOutput::finish() {
    file_->finish();
}

}  // namespace imgmesh
